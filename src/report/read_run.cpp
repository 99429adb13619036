#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/comparison.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/csv.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kLargestFile = 100'000'000;
const char* const kAllowed = "what `estimate` wrote of one recording";

double number(const json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

void read_json(const std::string& file, ComparedRun& out) {
  const json root = json::parse(read_file(file, file, kAllowed, kLargestFile), nullptr, false);
  if (!root.is_object()) throw InputError(file, "no JSON object", kAllowed);
  if (root.contains("recordings")) throw InputError(file + ": recordings", "several recordings", kAllowed);
  try {
    out.model = root.at("model").get<std::string>();
    out.model_text = root.at("model_text").get<std::string>();
    out.recording = root.at("recording").get<std::string>();
    out.state = root.at("state").get<std::string>();
    out.state_reason = root.at("state_reason").get<std::string>();
    out.frames = root.at("frames").get<int>();
    out.rms_error = number(root.at("rms_error"));
    out.noise_rms = number(root.at("noise_rms"));
    for (const auto& item : root.at("parameters").items()) {
      const json& p = item.value();
      out.parameters.push_back({item.key(), p.at("unit").get<std::string>(), number(p.at("mean")), number(p.at("std")),
                                number(p.at("interval95").at(0)), number(p.at("interval95").at(1))});
    }
  } catch (const json::exception& error) {
    throw InputError(file, error.what(), kAllowed);
  }
}

double number(const std::string& cell) {
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::strtod(cell.c_str(), nullptr);
}

std::size_t column(const std::vector<std::string>& head, const std::string& name, const std::string& file) {
  const auto found = std::find(head.begin(), head.end(), name);
  if (found == head.end()) throw InputError(file, "no column `" + name + "`", kAllowed);
  return static_cast<std::size_t>(found - head.begin());
}

void read_course(const std::string& file, ComparedRun& out) {
  const std::vector<std::vector<std::string>> rows = split_csv(read_file(file, file, kAllowed, kLargestFile));
  const std::vector<std::string> head = rows.empty() ? std::vector<std::string>() : rows.front();
  const std::size_t time = column(head, "time [s]", file), used = column(head, "used", file),
                    misfit = column(head, "misfit_rms [m]", file);
  std::vector<std::size_t> first;
  for (const ParameterEstimate& p : out.parameters) first.push_back(column(head, p.name + ".mean [" + p.unit + "]", file));
  out.mean.resize(first.size());
  out.lower = out.upper = out.mean;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const std::vector<std::string>& row = rows[k];
    if (row.size() != head.size()) throw InputError(file, "a row of " + std::to_string(row.size()) + " cells", kAllowed);
    if (row[used] != "1") continue;
    out.time.push_back(number(row[time]));
    out.misfit.push_back(number(row[misfit]));
    for (std::size_t p = 0; p < first.size(); ++p) {  // mean, std, lower95, upper95
      out.mean[p].push_back(number(row[first[p]]));
      out.lower[p].push_back(number(row[first[p] + 2]));
      out.upper[p].push_back(number(row[first[p] + 3]));
    }
  }
  for (std::size_t k = out.time.size(); k-- > 0;) out.time[k] -= out.time.front();
}

}  // namespace

ComparedRun read_run(const std::string& folder) {
  ComparedRun out;
  const std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
  out.name = (path.has_filename() ? path : path.parent_path()).string();
  read_json((path / "results.json").string(), out);
  read_course((path / "estimates.csv").string(), out);
  return out;
}

}  // namespace tissue_stiffness
