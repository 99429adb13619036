#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/estimate_at_last.hpp"
#include "diagnosis/replay_model.hpp"
#include "effects/registry.hpp"
#include "forward/for_each_index.hpp"
#include "report/effect_words.hpp"
#include "report/write_diagnosis.hpp"
#include "report/write_results.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/check_setup.hpp"
#include "tools/data_option.hpp"
#include "tools/gathered_files.hpp"
#include "tools/model_option.hpp"
#include "tools/print_diagnosis.hpp"
#include "tools/progress.hpp"
#include "tools/read_text.hpp"
#include "tools/recording_reader.hpp"
#include "tools/run_tool.hpp"
#include "tools/stop_on_signals.hpp"
#include "tools/versions.hpp"
#include "vtu/vtu_reader.hpp"

namespace {

using namespace tissue_stiffness;

/// Keeps the results if a final run fails, as with a prior that reaches impossible values.
void try_run(const std::string& what, const std::function<void()>& run) {
  try {
    run();
  } catch (const NumericalError& error) {
    std::cerr << "diagnose: " << what << " could not be run for the report: " << error.what() << "\n";
  }
}

std::map<std::string, std::string> parameter_units() {
  std::map<std::string, std::string> out;
  for (const EffectSpec& spec : effect_specs()) {
    for (const ParameterSpec& p : spec.parameters) {
      for (const std::string component : {"", "_x", "_y", "_z"}) out[spec.name + "." + p.name + component] = p.unit;
    }
  }
  return out;
}

/// Computes what the report shows beyond the diagnosis: the estimate, and the free runs of the given model and of the last
/// one, if effects were added.
void run_once_more(Diagnosis& diagnosis, FittedModel& given, FittedModel& last, const RecordingFit* finer,
                   const std::vector<double>& stamps, std::vector<Replay>& replays) {
  const auto replay = [&](FittedModel& fitted, const std::string& name) {
    Replay out = replay_model(fitted, stamps);
    out.name = name;
    return out;
  };
  Replay as_given, extended;
  run_side_by_side(
      [&] { try_run("the estimator", [&] { diagnosis.estimate = estimate_at_last(diagnosis, given, last, finer); }); },
      [&] { as_given = replay(given, "as given"); },
      [&] {
        if (&last == &given) return;
        try_run("the extended model", [&] { extended = replay(last, "with " + effect_list(diagnosis.final_effects)); });
      });
  replays.push_back(std::move(as_given));
  if (!extended.name.empty()) replays.push_back(std::move(extended));
}

}  // namespace

int main(int argc, char** argv) {
  StopRequest& stop = stop_on_signals();
  CommandLine line("Compares a model with a recording and says which physical effect it misses.", "diagnose");
  ModelOption model;
  DataOption data;
  DiagnosisTexts texts;
  DiagnosisOptions options;
  std::string output;
  double time_limit = 0.0;
  bool quiet = false, json = false;
  model.add_to(line);
  line.add_positional("RECORDING", texts.recording, "rosbag");
  data.add_to(line, "instead of a rosbag: ");
  line.add_option("--output", output, "folder for diagnosis.json, model_next.yaml and report.html").required();
  line.add_option("--add", options.add, "add this effect and fit again (may be given several times)");
  line.add_option("--ignore", options.ignore, "do not search for this effect (may be given several times)");
  line.add_flag("--auto", options.automatic, "keep adding the most probable effect while the verdict is `missing`");
  line.add_option("--time-limit", time_limit, "end after so many seconds with what is known then").positive();
  line.add_flag("--quiet", quiet, "no progress and no table");
  line.add_flag("--json", json, "print diagnosis.json instead of the table");
  line.footer(std::string("Example: diagnose model.yaml recording.bag --output out --auto\n"
                          "Without ROS: diagnose model.yaml --data /tissue/vertices=points.csv --output out --auto\n") +
              exit_code_help);
  accept_vtu_meshes();
  return run_tool(line, argc, argv, [&] {
    if (time_limit > 0.0) stop.end_after(time_limit);
    Diagnosis diagnosis;  // as long as nothing is known
    diagnosis.interrupted = "reading the model and the recording";
    options.so_far = [&](const Diagnosis& known) { write_text(output + "/diagnosis.json", diagnosis_json(known)); };
    data.check_beside(texts.recording);
    make_folder(output);
    options.so_far(diagnosis);
    const ModelSettings settings = model.load();
    if (!data.empty()) texts.recording = data.pack(settings, output);
    texts.model = model.file;
    StepProgress progress(std::cerr, Progress::style_of_stderr(quiet || json), "diagnose");
    options.progress = [&](const std::string& what, std::size_t done, std::size_t total) {
      progress.show(what, done, total);
    };
    Showing showing;
    try {
      warn_of_setup(
          "diagnose", settings, texts.recording, [&] { stop.check(); }, std::cerr);
      RecordingReader reader(texts.recording, settings, [&] { stop.check(); });
      progress.show("read the recording");
      const Recording recording = read_recording(reader, settings, texts.recording);
      showing = {recording.first_stamp, {}, reader.reader().pictures()};
      options.at_end = [&](Diagnosis& found, FittedModel& given, FittedModel& last, const RecordingFit* finer) {
        run_once_more(found, given, last, finer, reader.reader().picture_stamps(), showing.replays);
      };
      diagnosis = diagnose(settings, reader.mesh(), recording, options);
    } catch (const Interrupted&) {  // while the recording was read
    }
    texts.command_line = join_arguments("diagnose", argc, argv);
    texts.model_text = read_text(texts.model);
    texts.next_model_text = extend_model(texts.model_text, diagnosis.entries, settings.directory, GatheredFiles(output));
    texts.versions = versions();
    texts.units = parameter_units();
    write_diagnosis(diagnosis, texts, showing, output);
    progress.finish();
    if (json) {
      std::cout << diagnosis_json(diagnosis);
    } else if (!quiet) {
      print_diagnosis(diagnosis, Paint::for_stdout(), std::cout);
      std::cout << "written       " << output << "/{diagnosis.json,model_next.yaml,report.html}\n";
    }
    return exit_code(diagnosis);
  });
}
