#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model_option.hpp"
#include "tools/progress.hpp"
#include "tools/run_tool.hpp"
#include "tools/simulate_scene.hpp"
#include "vtu/vtu_reader.hpp"

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CommandLine line("Makes a recording of a body whose properties are known: a model file with `simulation`.", "simulate");
  ModelOption option;
  std::string output, truth;
  bool quiet = false, json = false, force = false;
  option.add_to(line, "SCENE", "scene file (YAML)");
  line.add_option("--output", output, "rosbag to write").required();
  line.add_option("--truth", truth, "file for the scene's numbers (YAML)");
  line.add_flag("--force", force, "simulate it however long that takes");
  line.add_flag("--quiet", quiet, "no progress and no summary");
  line.add_flag("--json", json, "print the summary as JSON");
  line.footer("Example: simulate scene.yaml --output recording.bag --truth truth.yaml");
  accept_vtu_meshes();
  return run_tool(line, argc, argv, [&] {
    option.check();
    const Scene scene = load_scene(option.file);
    if (!force) require_moderate(scene);
    Progress progress(std::cerr, Progress::style_of_stderr(quiet || json), "simulate");
    const SimulationSummary summary =
        simulate_scene(scene, output, [&](std::size_t done, std::size_t total) { progress.show(done, total); });
    progress.finish();
    if (!truth.empty()) write_truth(scene, summary, truth);
    if (json) {
      const nlohmann::json shown{{"recording", output},
                                 {"frames", summary.frames},
                                 {"nodes", summary.nodes},
                                 {"motion_rms", summary.motion_rms},
                                 {"motion_max", summary.motion_max}};
      std::cout << shown.dump(2) << "\n";
      return;
    }
    if (quiet) return;
    std::printf("%s: %d frames, %d nodes, motion %.3g mm rms, %.3g mm at most\n", output.c_str(), summary.frames,
                summary.nodes, 1e3 * summary.motion_rms, 1e3 * summary.motion_max);
  });
}
