#include <string>

#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/check_setup.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/model_option.hpp"
#include "tools/progress.hpp"
#include "tools/run_tool.hpp"
#include "tools/stop_on_signals.hpp"

namespace {

std::string join_arguments(int argc, char** argv) {
  std::string line = "estimate";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  StopRequest& stop = stop_on_signals();
  CLI::App app("Estimates the unknown parameters of a model, Young's modulus first, from a recording.", "estimate");
  ModelOption model;
  std::string recording, output;
  std::size_t frames = 0;
  double time_limit = 0.0;
  bool quiet = false, json = false;
  model.add_to(app);
  app.add_option("RECORDING", recording, "rosbag")->required();
  app.add_option("--output", output, "folder for results.json, estimates.csv, report.html and map.vtk")->required();
  app.add_option("--frames", frames, "stop after so many frames (default: all)")->check(CLI::PositiveNumber);
  app.add_option("--time-limit", time_limit, "end after so many seconds with what is known then")
      ->check(CLI::PositiveNumber);
  app.add_flag("--quiet", quiet, "no progress and no table");
  app.add_flag("--json", json, "print results.json instead of the table");
  app.footer(std::string("Example: estimate model.yaml recording.bag --output out\n") + exit_code_help);
  return run_tool(app, argc, argv, [&] {
    if (time_limit > 0.0) stop.end_after(time_limit);
    EstimationRun run;  // as long as nothing is known
    run.results.interrupted = "reading the model and the recording";
    make_folder(output);
    write_text(output + "/results.json", results_json(run.results));
    Progress progress(std::cerr, Progress::style_of_stderr(quiet || json), "estimate");
    const auto show = [&](std::size_t done, std::size_t total) { progress.show(done, total); };
    try {
      const ModelSettings settings = model.load();
      warn_of_setup(
          "estimate", settings, recording, [&] { stop.check(); }, std::cerr);
      run = estimate_recording(settings, recording, frames, show, stop);
    } catch (const Interrupted&) {
    }
    progress.finish();
    run.results.command_line = join_arguments(argc, argv);
    if (run.results.map) write_text(output + "/map.vtk", run.map_vtk);
    write_results(run.results, run.showing, output);
    if (json) {
      std::cout << results_json(run.results) << "\n";
    } else if (!quiet) {
      print_summary(run, Paint::for_stdout(), std::cout);
      std::cout << "written       " << output << "/{results.json,estimates.csv,report.html"
                << (run.results.map ? ",map.vtk}\n" : "}\n");
    }
    return exit_code(run.results);
  });
}
