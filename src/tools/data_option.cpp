#include "tools/data_option.hpp"

#include "tissue_stiffness/types/error.hpp"
#include "tools/command_line.hpp"

namespace tissue_stiffness {

void DataOption::add_to(CommandLine& line, const std::string& intent) {
  line.add_option("--data", data, intent + "TOPIC=FILE.csv for each topic of points and loads of the model");
  line.add_option("--video", films,
                  intent + "a film, or images frames_%04d.png, for each contour and for tracks of the model");
  line.add_option("--camera", cameras, "calibration of each film's camera, with its pose (YAML)");
  line.add_option("--scale", scale, "what converts the lengths of --data to metres, such as 0.001").positive();
}

void DataOption::check_beside(const std::string& recording) const {
  if (recording.empty() != empty()) return;
  throw InputError("RECORDING", empty() ? "nothing" : recording + " beside --data or --video",
                   "a rosbag, or --data and --video");
}

std::string DataOption::pack(const ModelSettings& settings, const std::string& folder) const {
  std::string bag = folder + "/recording.bag";
  pack_recording(settings, files(), bag);
  return bag;
}

PackedFiles DataOption::files() const {
  if (empty()) throw InputError("--data", "nothing", "TOPIC=FILE.csv, or --video and --camera");
  if (films.size() != cameras.size()) {
    throw InputError("--camera", std::to_string(cameras.size()) + " files",
                     std::to_string(films.size()) + ", one for each --video");
  }
  PackedFiles out;
  out.scale = scale;
  for (const std::string& text : data) out.topics.push_back(read_packed_topic(text));
  for (std::size_t k = 0; k < films.size(); ++k) out.films.push_back({films[k], cameras[k]});
  return out;
}

}  // namespace tissue_stiffness
