#include "tools/data_option.hpp"
#include "tools/model_option.hpp"
#include "tools/pack_recording.hpp"
#include "tools/run_tool.hpp"

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CommandLine line("Packs CSV files and films into the rosbag that a model needs, for what was recorded without ROS.",
                   "pack");
  ModelOption model;
  std::string output;
  DataOption data;
  model.add_to(line, "model");
  data.add_to(line, "");
  line.add_option("--output", output, "the bag").required();
  line.footer(
      "Rows of points: time, number, x, y, z (without the number for `points`); of a force: time, fx, fy, fz[, torque]; "
      "of\n"
      "a pressure: time, p; of a pose: time, x, y, z, qx, qy, qz, qw. All are in the model's frame, with SI units.\n"
      "A camera file is what camera_calibration writes, with a line `pose: [x, y, z, qx, qy, qz, qw]`; see "
      "doc/parameters.md.\n"
      "Example: pack model.yaml --data /tissue/vertices=points.csv /tool/wrench=force.csv --output recording.bag\n"
      "A film: pack model.yaml --video film.mp4 --camera camera.yaml --data /tool/wrench=force.csv --output recording.bag");
  return run_tool(line, argc, argv, [&] {
    for (const PackedSummary& topic : pack_recording(model.load(), data.files(), output)) {
      std::cout << topic.topic << ": " << topic.messages << " messages over " << topic.duration << " s\n";
    }
  });
}
