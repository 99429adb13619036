#include <string>

#include "tools/check_setup.hpp"
#include "tools/model_option.hpp"
#include "tools/run_tool.hpp"
#include "vtu/vtu_reader.hpp"

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CommandLine line("Says what is wrong with a model file, and with a recording for it, before anything is estimated.",
                   "check");
  ModelOption model;
  std::string recording;
  bool quiet = false;
  model.add_to(line);
  line.add_positional("RECORDING", recording, "rosbag; without it the model file and the mesh are checked");
  line.add_flag("--quiet", quiet, "nothing where nothing is wrong");
  line.footer("Example: check model.yaml recording.bag");
  std::size_t found = 0;
  accept_vtu_meshes();
  const int code = run_tool(line, argc, argv, [&] {
    const SetupFindings findings = check_setup(model.load(), recording);
    for (const SetupFinding& finding : findings) std::cout << finding.sentence << "\n";
    if (findings.empty() && !quiet) std::cout << "nothing found\n";
    found = findings.size();
  });
  return code == 0 && found > 0 ? 2 : code;
}
