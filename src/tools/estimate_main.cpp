#include <string>
#include <vector>

#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/check_setup.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/merge_manifest.hpp"
#include "tools/model_option.hpp"
#include "tools/progress.hpp"
#include "tools/run_manifest.hpp"
#include "tools/run_tool.hpp"
#include "tools/stop_on_signals.hpp"

namespace {

using namespace tissue_stiffness;

std::string join_arguments(int argc, char** argv) {
  std::string line = "estimate";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

/// Arguments of `estimate` for the recordings of a manifest.
struct ManifestArguments {
  std::string file, shard = "1/1", merged;
  ManifestTask task;

  void add_to(CLI::App& app) {
    CLI::Option* const manifest =
        app.add_option("--manifest", file, "CSV file with the columns model and recording: estimate from each of its rows");
    app.add_option("--shard", shard, "I/N: every N-th row of the manifest, beginning with the I-th (default: 1/1)")
        ->needs(manifest);
    app.add_option("--threads", task.processes, "rows of the manifest that are estimated at once (default: 1)")
        ->needs(manifest)
        ->check(CLI::Range(1, 1000));
    app.add_flag("--resume", task.resume, "keep the rows of the manifest that are answered already")->needs(manifest);
    app.add_option("--merge", merged, "estimate nothing; write this CSV file with a row for each row of the manifest")
        ->needs(manifest);
  }
};

// Returns the arguments that every row's results depend on.
std::vector<std::string> row_arguments(const ModelOption& model, std::size_t frames) {
  std::vector<std::string> out;
  if (frames > 0) out.insert(out.end(), {"--frames", std::to_string(frames)});
  if (model.allow_outside) out.emplace_back("--allow-outside");
  return out;
}

ExitCode estimate_manifest(ManifestArguments& arguments, bool quiet, const StopRequest& stop) {
  const Manifest manifest = read_manifest(arguments.file);
  ManifestTask& task = arguments.task;
  read_shard(arguments.shard, task);
  if (!arguments.merged.empty()) {
    write_text(arguments.merged, merge_manifest(manifest, task.output, task.arguments));
    return ExitCode::answered;
  }
  make_folder(task.output);
  Progress progress(std::cerr, Progress::style_of_stderr(quiet), "estimate");
  const ManifestOutcome out = run_manifest(
      manifest, task, [&](std::size_t over, std::size_t total) { progress.show(over, total); }, stop);
  progress.finish();
  if (!quiet) {
    std::cout << out.answered << " rows answered, " << out.kept << " kept, " << out.failed << " failed, " << out.interrupted
              << " not finished; in " << task.output << "\n";
  }
  if (out.interrupted > 0) return ExitCode::interrupted;
  return out.failed > 0 ? ExitCode::failed : ExitCode::answered;
}

}  // namespace

int main(int argc, char** argv) {
  StopRequest& stop = stop_on_signals();
  CLI::App app("Estimates the unknown parameters of a model, Young's modulus first, from a recording.", "estimate");
  ModelOption model;
  std::string recording, output;
  std::size_t frames = 0;
  double time_limit = 0.0;
  bool quiet = false, json = false;
  ManifestArguments many;
  model.add_to(app);
  app.get_option("MODEL")->required(false);
  app.add_option("RECORDING", recording, "rosbag");
  app.add_option("--output", output, "folder for results.json, estimates.csv, report.html and map.vtk")->required();
  app.add_option("--frames", frames, "stop after so many frames (default: all)")->check(CLI::PositiveNumber);
  app.add_option("--time-limit", time_limit, "end after so many seconds with what is known then")
      ->check(CLI::PositiveNumber);
  app.add_flag("--quiet", quiet, "no progress and no table");
  app.add_flag("--json", json, "print results.json instead of the table");
  many.add_to(app);
  app.footer(std::string("Example: estimate model.yaml recording.bag --output out\n") + exit_code_help);
  return run_tool(app, argc, argv, [&] {
    if (time_limit > 0.0) stop.end_after(time_limit);
    if (!many.file.empty()) {
      if (!model.file.empty()) throw CLI::ExcludesError("--manifest", "MODEL");
      many.task.output = output;
      many.task.arguments = row_arguments(model, frames);
      return estimate_manifest(many, quiet, stop);
    }
    if (recording.empty()) throw CLI::RequiredError(model.file.empty() ? "MODEL" : "RECORDING");
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
