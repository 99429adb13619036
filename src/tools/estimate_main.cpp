#include <string>

#include "tissue_stiffness/report/write_results.hpp"
#include "tissue_stiffness/tools/estimate_recording.hpp"
#include "tissue_stiffness/tools/progress.hpp"
#include "tissue_stiffness/tools/run_tool.hpp"

namespace {

std::string join_arguments(int argc, char** argv) {
  std::string line = "estimate";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CLI::App app("Estimates the unknown parameters of a model, Young's modulus first, from a recording.", "estimate");
  std::string model, recording, output;
  std::size_t frames = 0;
  bool quiet = false, json = false;
  app.add_option("MODEL", model, "model file (YAML)")->required();
  app.add_option("RECORDING", recording, "rosbag")->required();
  app.add_option("--output", output, "folder for results.json, estimates.csv, report.html and map.vtk")->required();
  app.add_option("--frames", frames, "stop after so many frames (default: all)")->check(CLI::PositiveNumber);
  app.add_flag("--quiet", quiet, "no progress and no table");
  app.add_flag("--json", json, "print results.json instead of the table");
  app.footer("Example: estimate model.yaml recording.bag --output out");
  return run_tool(app, argc, argv, [&] {
    Progress progress(std::cerr, Progress::style_of_stderr(quiet || json), "estimate");
    EstimationRun run = estimate_recording(model, recording, frames,
                                           [&](std::size_t done, std::size_t total) { progress.show(done, total); });
    progress.finish();
    run.results.command_line = join_arguments(argc, argv);
    write_results(run.results, run.showing, output);
    if (run.results.map) write_text(output + "/map.vtk", run.map_vtk);
    if (json) {
      std::cout << results_json(run.results) << "\n";
    } else if (!quiet) {
      print_summary(run, Paint::for_stdout(), std::cout);
      std::cout << "written       " << output << "/{results.json,estimates.csv,report.html"
                << (run.results.map ? ",map.vtk}\n" : "}\n");
    }
  });
}
