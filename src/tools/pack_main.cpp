#include "tools/model_option.hpp"
#include "tools/pack_recording.hpp"
#include "tools/run_tool.hpp"

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CLI::App app("Packs CSV files into the rosbag that a model needs, for what was recorded without ROS.", "pack");
  ModelOption model;
  std::string output;
  std::vector<std::string> data;
  double scale = 1.0;
  model.add_to(app, "model");
  app.add_option("--data", data, "TOPIC=FILE.csv, for each topic of the model")->required();
  app.add_option("--scale", scale, "what converts the files' lengths to metres, such as 0.001")->check(CLI::PositiveNumber);
  app.add_option("--output", output, "the bag")->required();
  app.footer(
      "Rows of points: time, number, x, y, z (without the number for `points`); of a force: time, fx, fy, fz[, torque]; "
      "of\n"
      "a pressure: time, p; of a pose: time, x, y, z, qx, qy, qz, qw. All are in the model's frame, with SI units.\n"
      "Example: pack model.yaml --data /tissue/vertices=points.csv /tool/wrench=force.csv --output recording.bag");
  return run_tool(app, argc, argv, [&] {
    std::vector<PackedTopic> topics;
    topics.reserve(data.size());
    for (const std::string& text : data) topics.push_back(read_packed_topic(text));
    for (const PackedSummary& topic : pack_recording(model.load(), topics, scale, output)) {
      std::cout << topic.topic << ": " << topic.messages << " messages over " << topic.duration << " s\n";
    }
  });
}
