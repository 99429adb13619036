#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "export/formats.hpp"
#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/estimated_model.hpp"
#include "tools/run_tool.hpp"
#include "vtu/vtu_reader.hpp"

namespace {

using namespace tissue_stiffness;

struct Format {
  std::string ending;
  std::function<ExportFile(const ExportedModel&)> write;
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> all = {{"vtu", {".vtu", vtu_file}},
                                                    {"calculix", {".inp", calculix_file}},
                                                    {"febio", {".feb", febio_file}},
                                                    {"sofa", {".scn", sofa_file}},
                                                    {"usd", {".usda", usd_file}}};
  return all;
}

// Returns the time on the recording's clock.
double time_of(const EstimatedModel& estimated, std::optional<double> at) {
  const std::vector<double>& times = estimated.load_times;
  if (!at) return time_of_largest_load(*estimated.model, estimated.theta, times);
  const double first = estimated.model->loads().first_stamp();
  const double end = times.empty() ? 0.0 : *std::max_element(times.begin(), times.end()) - first;
  if (!(*at >= 0.0 && *at <= end)) {
    std::ostringstream value, allowed;
    value << *at << " s";
    allowed << "0 to " << end << " s, while the loads are known";
    throw InputError("--at", value.str(), allowed.str());
  }
  return first + *at;
}

std::string title_of(const EstimatedModel& estimated) {
  std::ostringstream out;
  out << "tissue_stiffness: model of " << estimated.results.model << " as estimated from " << estimated.results.recording;
  for (const auto& [name, value] : estimated.results.parameters) out << "; " << name << " = " << value;
  return out.str();
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line("Writes the estimated model for another program, with its loads at one instant.", "export");
  ModelOption given;
  std::string results, to, output, recording;
  std::optional<double> at;
  bool quiet = false;
  std::vector<std::string> names;
  for (const auto& [name, format] : formats()) names.push_back(name);
  line.add_positional("RESULTS", results, "results.json of `estimate`, or its folder").required();
  line.add_option("--to", to, "the format").required().one_of(names);
  line.add_option("-o,--output", output, "the file (default: model.ENDING beside results.json)");
  line.add_option("--at", at, "time of the loads after the recording's first stamp [s] (default: of the largest load)");
  line.add_option("--model", given.file, "the model file (default: as results.json says)");
  line.add_option("--recording", recording, "the rosbag (default: as results.json says)");
  given.add_flag_to(line);
  line.add_flag("--quiet", quiet, "no word about what was written");
  line.footer(
      "Example: export out --to calculix -o liver.inp\nWhat the format cannot express is said on stderr and in the file.");
  accept_vtu_meshes();
  return run_tool(line, argc, argv, [&] {
    const EstimatedModel estimated = load_estimated_model(results, given, recording);
    const Format& format = formats().at(to);
    ExportedModel exported = export_model(*estimated.model, estimated.theta, time_of(estimated, at),
                                          estimated.mapped_modulus, estimated.common_modulus);
    exported.title = title_of(estimated);
    exported.remarks.insert(exported.remarks.begin(), estimated.remarks.begin(), estimated.remarks.end());
    const ExportFile file = format.write(exported);
    if (output.empty())
      output = (std::filesystem::path(estimated.results.file).parent_path() / ("model" + format.ending)).string();
    write_text(output, file.text);
    for (const std::string& remark : file.remarks) std::cerr << "export: note: " << remark << "\n";
    if (!quiet) std::cout << "written " << output << ", loads at " << exported.time << " s\n";
  });
}
