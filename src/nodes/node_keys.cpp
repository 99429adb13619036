#include "nodes/node_keys.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace tissue_stiffness {
namespace {

KeySpec frame() {
  return text_key("model_frame", "model", "tf frame that the model lives in");
}

KeySpec patience(double seconds) {
  return number_key("transform_timeout", "s", 0, 60, seconds, "how long to wait for a sensor's pose on tf, in wall time");
}

KeySpec diagnostic_period() {
  return number_key("diagnostic_period", "s", 0.1, 60, 1, "wall time between messages on /diagnostics");
}

KeySpec rate(const std::string& path, const std::string& meaning) {
  return number_key(path, "", 0, 1, 0.01, "probability that a message " + meaning);
}

const std::vector<std::pair<std::string, std::vector<KeySpec>>>& all_keys() {
  static const std::vector<std::pair<std::string, std::vector<KeySpec>>> keys{
      {"fault_injector",
       {required_key("topics", KeySpec::Kind::list, "", "the topics that pass through"),
        required_key("topics[].input", KeySpec::Kind::text, "", "topic of the sensor"),
        required_key("topics[].output", KeySpec::Kind::text, "", "topic of the nodes behind"),
        integer_key("seed", 0, std::numeric_limits<int>::max(), 1, "of all that is random"), rate("drop", "is lost"),
        rate("delay", "comes late"), rate("duplicate", "comes twice"), rate("reorder", "comes after the next one"),
        rate("corrupt", "loses its stamp, its frame or its end, or holds numbers that are not finite or too few"),
        rate("restamp", "has a stamp of some seconds before or after, or of an hour after"),
        number_key("mute", "Hz", 0, 1, 0.01, "how often a topic falls silent"),
        number_key("longest_delay", "s", 0, 60, 0.3,
                   "between stamps, like the times below; each fault draws its own length"),
        number_key("longest_shift", "s", 0, 60, 5, "of a stamp"), number_key("longest_mute", "s", 0, 3600, 3, "of a topic"),
        number_key("quiet", "s", 0, 1e6, 0, "how long none happens; 0: they always do"),
        number_key("active", "s", 0, 1e6, 0, "how long they then happen, in turns with `quiet`"), diagnostic_period()}},
      {"segmentation_node",
       {plain_key("segmentation", KeySpec::Kind::map, "",
                  "`{kind, ...}` as in a model file's contour, for a node without a model"),
        number_key("contour_number", "", 1, 100, 1, "which of the model's contours"),
        number_key("queue_size", "images", 1, 1e4, 100, "that may wait before the oldest is dropped"),
        diagnostic_period()}},
      {"mesh_node",
       {frame(), patience(1.0),
        text_key("mesh_folder", "",
                 "folder that the services read meshes from and save them to; empty: none may be saved, and those of the "
                 "model file's folder may be read")}},
      {"estimator_node",
       {frame(), patience(0.1),
        number_key("load_timeout", "s", 0, 60, 0.1, "how long a frame waits for the loads up to its stamp, in wall time"),
        number_key("queue_size", "frames", 1, 1e5, 100, "that may wait before the oldest is dropped"),
        number_key("diagnosis_period", "s", 0, 1e6, 10,
                   "wall time between checks of what the model misses; 0: on request only"),
        number_key("diagnosis_window", "s", 1, 1e5, 20, "how much of the run a check sees"),
        number_key("converged_within", "", 0.001, 0.2, 0.2,
                   "relative standard deviation up to which an estimate may be `converged`"),
        number_key("stale_after", "s", std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity(),
                   std::nan(""),
                   "without a measurement or a load for so long the state is `stale`; the model's where absent"),
        number_key("colour_limit", "", 0.1, 1000, 3,
                   "misfit from which `tracked_surface` is red, in standard deviations of the noise"),
        diagnostic_period()}}};
  return keys;
}

}  // namespace

const std::vector<KeySpec>& common_node_keys() {
  static const std::vector<KeySpec> keys{
      text_key("model", "", "the model file; without it the private parameters are the model's keys themselves"),
      text_key("directory", "",
               "where relative files are looked up when there is no `model`; the working directory when absent"),
      plain_key("allow_outside", KeySpec::Kind::boolean, "",
                "let the model name files outside its own folder, or outside `directory`")};
  return keys;
}

const std::vector<KeySpec>& node_keys(const std::string& node) {
  for (const auto& [name, keys] : all_keys()) {
    if (name == node) return keys;
  }
  throw std::logic_error("no node " + node);
}

const std::vector<std::string>& node_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const auto& node : all_keys()) out.push_back(node.first);
    return out;
  }();
  return names;
}

std::vector<std::string> names_of(const std::vector<KeySpec>& keys) {
  std::vector<std::string> out;
  for (const KeySpec& key : keys) out.push_back(key.path);
  return out;
}

}  // namespace tissue_stiffness
