#include <fstream>
#include <iterator>
#include <string>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/report/write_diagnosis.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"
#include "tissue_stiffness/tools/print_diagnosis.hpp"
#include "tissue_stiffness/tools/recording_reader.hpp"
#include "tissue_stiffness/tools/run_tool.hpp"

namespace {

std::string read_text(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CLI::App app("Compares a model with a recording and says which physical effect it misses.", "diagnose");
  DiagnosisTexts texts;
  DiagnosisOptions options;
  std::string output;
  bool quiet = false, json = false;
  app.add_option("MODEL", texts.model, "model file (YAML)")->required();
  app.add_option("RECORDING", texts.recording, "rosbag")->required();
  app.add_option("--output", output, "folder for diagnosis.json, model_next.yaml and report.html")->required();
  app.add_option("--add", options.add, "add this effect and fit again (may be given several times)")->take_all();
  app.add_option("--ignore", options.ignore, "do not look for this effect (may be given several times)")->take_all();
  app.add_flag("--auto", options.automatic, "keep adding the best effect while the held-out error proves it");
  app.add_flag("--quiet", quiet, "no progress and no table");
  app.add_flag("--json", json, "print diagnosis.json instead of the table");
  return run_tool(app, argc, argv, [&] {
    const ModelSettings settings = load_model(texts.model);
    RecordingReader reader(texts.recording, settings);
    const auto say = [&](const std::string& what) {
      if (!quiet && !json) std::cerr << "diagnose: " << what << "\n";
    };
    say("read the recording");
    const Recording recording = read_recording(reader, settings, texts.recording);
    options.progress = say;
    const Diagnosis diagnosis = diagnose(settings, reader.mesh(), recording, options);
    for (int i = 0; i < argc; ++i) texts.command_line += (i > 0 ? " " : "") + std::string(i > 0 ? argv[i] : "diagnose");
    texts.model_text = read_text(texts.model);
    texts.next_model_text = extend_model(texts.model_text, diagnosis.entries, settings.directory);
    write_diagnosis(diagnosis, texts, output);
    if (json) {
      std::cout << diagnosis_json(diagnosis);
    } else if (!quiet) {
      print_diagnosis(diagnosis, std::cout);
      std::cout << "written       " << output << "/{diagnosis.json,model_next.yaml,report.html}\n";
    }
  });
}
