#include "tools/read_image_scene.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "segmentation/lens.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/scene_keys.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void read_size(const Value& map, Camera& camera) {
  camera.width = 640;
  camera.height = 480;
  if (!map.has("size")) return;
  const Value& size = map.at("size");
  if (size.items().size() != 2) throw InputError(size.path(), size.shown(), "[width, height] [pixel]");
  camera.width = size.items()[0].as_integer(16, 16384);
  camera.height = size.items()[1].as_integer(16, 16384);
}

/// Returns a frame whose columns x and y are perpendicular to z and each other, starting from y.
Eigen::Matrix3d frame_of(const Eigen::Vector3d& y, const Eigen::Vector3d& z, const Value& where) {
  Eigen::Matrix3d rotation;
  const Eigen::Vector3d x = y.cross(z);
  if (x.norm() < 1e-6 * y.norm() * z.norm() || !(x.norm() > 0.0)) {
    throw InputError(where.path(), where.shown(), "two directions that are not parallel");
  }
  rotation << x.normalized(), z.cross(x).normalized(), z.normalized();
  return rotation;
}

void read_pinhole(const Value& map, Camera& camera) {
  camera.projection = Camera::Projection::pinhole;
  camera.fx = camera.fy = read_number(map, scene_key("sensors.*.focal_length"));
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  if (map.has("distortion")) {
    std::vector<double> coefficients;
    for (const Value& item : map.at("distortion").items()) {
      coefficients.push_back(item.as_number(-kInfinity, kInfinity, ""));
    }
    set_lens(read_choice(map, scene_key("sensors.*.distortion_model")), coefficients, map.path(), &camera);
  }
  const Eigen::Vector3d position = map.at("position").as_vector3("m");
  const Eigen::Vector3d forward = map.at("target").as_vector3("m") - position;
  const Eigen::Vector3d up = map.has("up") ? map.at("up").as_vector3("") : Eigen::Vector3d::UnitZ();
  camera.model_from_sensor.translation() = position;
  camera.model_from_sensor.linear() = frame_of(-up, forward, map);
}

void read_sector(const Value& map, ImageScene& image) {
  Camera& camera = image.camera;
  camera.projection = Camera::Projection::slice;
  camera.fx = camera.fy = read_number(map, scene_key("sensors.*.pixels_per_metre"));
  image.apex = {0.5 * (camera.width - 1), 8.0};
  camera.cx = image.apex.x();
  camera.cy = image.apex.y();
  const Eigen::Vector3d axis = map.at("axis").as_vector3(""), lateral = map.at("lateral").as_vector3("");
  camera.model_from_sensor.translation() = map.at("apex").as_vector3("m");
  camera.model_from_sensor.linear() = frame_of(axis, lateral.cross(axis), map);
  image.sector = read_number(map, scene_key("sensors.*.sector")) * M_PI / 180.0;
  image.depth = read_number(map, scene_key("sensors.*.depth")) * camera.fx;
  image.drop_out = read_number(map, scene_key("sensors.*.drop_out"));
}

}  // namespace

ImageScene read_image_scene(const Value& map, const ObservationSettings& observation) {
  ImageScene image;
  read_size(map, image.camera);
  if (observation.projection == ObservationSettings::Projection::slice) {
    read_sector(map, image);
  } else {
    read_pinhole(map, image.camera);
  }
  image.noise = map.number_or("noise", image.noise, 0.0, 100.0, "grey values");
  image.blur = read_number(map, scene_key("sensors.*.blur"));
  return image;
}

}  // namespace tissue_stiffness
