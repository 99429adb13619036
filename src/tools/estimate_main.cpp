#include <string>
#include <utility>
#include <vector>

#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/check_setup.hpp"
#include "tools/data_option.hpp"
#include "tools/estimate_jointly.hpp"
#include "tools/manifest_option.hpp"
#include "tools/model_option.hpp"
#include "tools/progress.hpp"
#include "tools/run_tool.hpp"
#include "tools/stop_on_signals.hpp"
#include "vtu/vtu_reader.hpp"

namespace {

using namespace tissue_stiffness;

// Returns the arguments that every row's results depend on.
std::vector<std::string> row_arguments(const ModelOption& model, std::size_t frames) {
  std::vector<std::string> out;
  if (frames > 0) out.insert(out.end(), {"--frames", std::to_string(frames)});
  if (model.allow_outside) out.emplace_back("--allow-outside");
  return out;
}

// Returns the recordings to fit and those to foretell.
std::vector<RecordingFile> recordings_of(const ModelOption& model, const std::vector<std::string>& fitted,
                                         const std::vector<std::string>& predicted) {
  std::vector<RecordingFile> out = pair_files(fitted, model.file, false);
  for (RecordingFile& file : pair_files(predicted, model.file, true)) out.push_back(std::move(file));
  for (const RecordingFile& file : out) ModelOption{file.model, model.allow_outside}.check();
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  StopRequest& stop = stop_on_signals();
  CommandLine line("Estimates the unknown parameters of a model, Young's modulus first, from a recording.", "estimate");
  ModelOption model;
  std::string output;
  std::vector<std::string> files, predicted, own;
  DataOption data;
  std::size_t frames = 0;
  double time_limit = 0.0;
  bool quiet = false, json = false;
  ManifestOption many;
  model.add_to(line).required(false);
  line.add_positional("RECORDING", files,
                      "rosbag; several of one body are fitted together, each with the model file before it");
  data.add_to(line, "instead of a rosbag: ");
  line.add_option("--predict", predicted,
                  "rosbags that the fit of the others foretells; MODEL RECORDING for another model");
  line.add_option("--own", own, "parameter, effect or topic that each of several recordings has for itself");
  line.add_option("--output", output, "folder for results.json, estimates.csv, report.html and map.vtk").required();
  line.add_option("--frames", frames, "stop after so many frames (default: all)").positive();
  line.add_option("--time-limit", time_limit, "end after so many seconds with what is known then").positive();
  line.add_flag("--quiet", quiet, "no progress and no table");
  line.add_flag("--json", json, "print results.json instead of the table");
  many.add_to(line);
  line.footer(
      std::string(
          "Example: estimate model.yaml recording.bag --output out\n"
          "Without ROS: estimate model.yaml --data /tissue/vertices=points.csv /tool/wrench=force.csv --output out\n"
          "A film: estimate model.yaml --video film.mp4 --camera camera.yaml --output out\n"
          "Several recordings: estimate a.yaml 1.bag 2.bag b.yaml 3.bag --predict 4.bag --output out\n") +
      exit_code_help);
  accept_vtu_meshes();
  return run_tool(line, argc, argv, [&] {
    if (time_limit > 0.0) stop.end_after(time_limit);
    if (!many.file.empty()) {
      if (!model.file.empty())
        throw UsageError("MODEL", model.file + " beside --manifest", "nothing, because the manifest names it");
      many.task.output = output;
      many.task.arguments = row_arguments(model, frames);
      return estimate_manifest(many, quiet, stop);
    }
    if (model.file.empty()) throw UsageError("MODEL is required");
    data.check_beside(files.empty() ? "" : files.front());
    make_folder(output);
    if (!data.empty()) files.push_back(data.pack(model.load(), output));
    const std::vector<RecordingFile> recordings = recordings_of(model, files, predicted);
    const bool several = recordings.size() > 1;
    if (!several && !own.empty()) throw InputError("--own", own.front(), "nothing, with a single recording");
    EstimationRun run;  // as long as nothing is known
    run.results.interrupted = "reading the model and the recording";
    write_text(output + "/results.json", results_json(run.results));
    Progress progress(std::cerr, Progress::style_of_stderr(quiet || json), "estimate");
    StepProgress steps(std::cerr, Progress::style_of_stderr(quiet || json || !several), "estimate");
    const auto show = [&](std::size_t done, std::size_t total) { progress.show(done, total); };
    try {
      const auto load_checked = [&](const RecordingFile& file) {
        ModelSettings settings = load_model(file.model);
        warn_of_setup(
            "estimate", settings, file.recording, [&] { stop.check(); }, std::cerr);
        return settings;
      };
      if (several) {
        for (const RecordingFile& file : recordings) load_checked(file);
        run = estimate_jointly(recordings, own, frames, steps, stop);
      } else {
        const RecordingFile& file = recordings.front();
        run = estimate_recording(load_checked(file), file.recording, frames, show, stop);
      }
    } catch (const Interrupted&) {
    }
    progress.finish();
    steps.finish();
    run.results.command_line = join_arguments("estimate", argc, argv);
    if (run.results.map) write_text(output + "/map.vtk", run.map_vtk);
    write_results(run.results, run.showing, output);
    if (json) {
      std::cout << results_json(run.results) << "\n";
    } else if (!quiet) {
      print_summary(run, Paint::for_stdout(), std::cout);
      std::cout << "written       " << output << "/{results.json,report.html" << (several ? "" : ",estimates.csv")
                << (run.results.map ? ",map.vtk}\n" : "}\n");
    }
    return exit_code(run.results);
  });
}
