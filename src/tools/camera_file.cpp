#include "tools/camera_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "segmentation/lens.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/read_pose.hpp"

namespace tissue_stiffness {
namespace {

using Kind = KeySpec::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPositive = std::numeric_limits<double>::min();
constexpr int kLargest = 16384;  // [pixel]

KeySpec required_size(const std::string& path, const std::string& meaning) {
  KeySpec out = integer_key(path, 1, kLargest, 0, meaning);
  out.unit = "pixel";
  out.required = true;
  return out;
}

const KeySpec& key(const std::string& path) {
  return find_key(camera_keys(), path);
}

std::vector<double> read_numbers(const Value& list) {
  std::vector<double> out;
  for (const Value& item : list.items()) out.push_back(item.as_number(-kInfinity, kInfinity, ""));
  return out;
}

// Reads what camera_calibration calls a matrix: rows, cols and data.
std::vector<double> read_matrix(const Value& map) {
  std::vector<double> out = read_numbers(map.at("data"));
  map.mark_read_deep();
  return out;
}

void read_intrinsics(const Value& root, Camera& camera) {
  camera.width = read_integer(root, key("image_width"));
  camera.height = read_integer(root, key("image_height"));
  const Value& matrix = root.at("camera_matrix");
  const std::vector<double> k = read_matrix(matrix);
  const bool usual = k.size() == 9 && k[0] > 0.0 && k[4] > 0.0 && k[1] == 0.0 && k[3] == 0.0;
  if (!usual) throw InputError(matrix.at("data").path(), matrix.at("data").shown(), "[fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  if (!root.has("distortion_coefficients")) return;
  const std::vector<double> lens = read_matrix(root.at("distortion_coefficients"));
  set_lens(read_choice(root, key("distortion_model")), lens, root.at("distortion_coefficients").path(), &camera);
}

Eigen::Isometry3d read_sensor_pose(const Value& list) {
  const std::vector<double> numbers = read_numbers(list);
  if (numbers.size() != 7) throw InputError(list.path(), list.shown(), "[x, y, z, qx, qy, qz, qw]");
  const Eigen::Map<const Eigen::Matrix<double, 7, 1>> n(numbers.data());
  return Eigen::Translation3d(n.head<3>()) * unit_rotation({n[6], n[3], n[4], n[5]}, list.path());
}

}  // namespace

const std::vector<KeySpec>& camera_keys() {
  static const std::vector<KeySpec> keys = {
      required_size("image_width", "width of the film's frames"),
      required_size("image_height", "height of the film's frames"),
      required_key("camera_matrix", Kind::map, "pixel",
                   "its `data` are [fx, 0, cx, 0, fy, cy, 0, 0, 1]; of a slice, pixels a metre"),
      choice_key("distortion_model", {"plumb_bob", "rational_polynomial", "equidistant"}, false,
                 "which model the lens has"),
      plain_key("distortion_coefficients", Kind::map, "",
                "its `data` are D of sensor_msgs/CameraInfo; no lens when absent"),
      required_key("pose", Kind::numbers, "m",
                   "[x, y, z, qx, qy, qz, qw] of the sensor's optical frame in the model frame"),
      number_key("rate", "1/s", kPositive, kInfinity, std::numeric_limits<double>::quiet_NaN(),
                 "frames a second; the film's own when absent; images have none"),
      number_key("start", "s", -kInfinity, kInfinity, 0, "time of the first frame, by the clock of the CSV files"),
      plain_key("camera_name", Kind::text, "", "not used, as are the next two"),
      plain_key("rectification_matrix", Kind::map, "", "of a stereo camera"),
      plain_key("projection_matrix", Kind::map, "", "of a stereo camera"),
  };
  return keys;
}

FilmCamera read_camera_file(const std::string& file, const ObservationSettings& observation) {
  const Value root = load_yaml(file);
  if (root.type() != Value::Type::map)
    throw InputError(root.path(), root.shown(), "a map: image_width, camera_matrix, ...");
  FilmCamera out;
  const bool slice = observation.projection == ObservationSettings::Projection::slice;
  out.camera.projection = slice ? Camera::Projection::slice : Camera::Projection::pinhole;
  read_intrinsics(root, out.camera);
  out.camera.model_from_sensor = read_sensor_pose(root.at("pose"));
  if (root.has("rate")) out.rate = read_number(root, key("rate"));
  out.start = read_number(root, key("start"));
  for (const std::string unused : {"camera_name", "rectification_matrix", "projection_matrix"}) {
    if (root.has(unused)) root.at(unused).mark_read_deep();
  }
  root.require_all_read();
  return out;
}

}  // namespace tissue_stiffness
