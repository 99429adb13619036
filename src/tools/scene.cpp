#include "tools/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/estimator_inputs.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_image_scene.hpp"
#include "tools/scene_keys.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::VectorXd read_direction(const Value& term, LoadInput::Kind kind) {
  if (kind == LoadInput::Kind::pressure) return Eigen::VectorXd::Ones(1);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(6);
  if (kind == LoadInput::Kind::pose && term.has("axis")) {
    out.tail<3>() = term.at("axis").as_vector3("").normalized();
  } else {
    out.head<3>() = term.at("direction").as_vector3("");
  }
  return out;
}

LoadScene read_load(const Value& map, const LoadInput& input, const std::string& directory) {
  LoadScene load;
  load.input = input;
  load.rate = read_number(map, scene_key("loads.*.rate"));
  load.noise = read_number(map, scene_key("loads.*.noise"));
  if (map.has("position")) load.position = map.at("position").as_vector3("m");
  for (const Value& term : map.at("terms").items()) {
    load.terms.push_back({read_direction(term, input.kind), read_signal(term, directory)});
  }
  if (load.terms.empty()) throw InputError(map.at("terms").path(), "an empty list", "at least one term");
  return load;
}

SensorScene read_sensor(const Value* map, const ObservationSettings& observation, const std::string& where) {
  SensorScene sensor;
  sensor.noise = observation.noise;
  if (observation.kind == ObservationSettings::Kind::points)
    sensor.points = read_integer(Value::map({}, where), scene_key("sensors.*.count"));
  if (traits_of(observation.kind).image) {
    if (map == nullptr) throw InputError(where, "nothing for " + observation.topic, "the camera of that topic");
    sensor.image = read_image_scene(*map, observation);
    sensor.image->fine = observation.kind == ObservationSettings::Kind::tracks;
    return sensor;
  }
  if (map == nullptr) return sensor;
  sensor.noise = map->number_or("noise", observation.noise, 0.0, kInfinity, "m");
  const bool points = observation.kind == ObservationSettings::Kind::points;
  if (!points) sensor.memory = read_number(*map, scene_key("sensors.*.memory"));
  if (points) sensor.points = read_integer(*map, scene_key("sensors.*.count"));
  if (observation.kind == ObservationSettings::Kind::vertices && map->has("ids")) {
    for (const Value& id : map->at("ids").items())
      sensor.vertices.push_back(id.as_integer(0, std::numeric_limits<int>::max()));
  } else if (observation.kind == ObservationSettings::Kind::vertices) {
    sensor.every = read_integer(*map, scene_key("sensors.*.every"));
  }
  return sensor;
}

}  // namespace

Eigen::VectorXd LoadScene::value(double time) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(terms.front().direction.size());
  for (const Term& term : terms) sum += term.signal(time) * term.direction;
  if (input.kind != LoadInput::Kind::pose) return sum;
  const double angle = sum.tail<3>().norm();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position + sum.head<3>();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, sum.tail<3>() / angle).toRotationMatrix();
  return pose_values(pose);
}

Scene load_scene(const std::string& file) {
  const Value root = load_yaml(file);
  const std::size_t slash = file.find_last_of('/');
  const std::string directory = slash == std::string::npos ? "." : file.substr(0, slash);
  const Value simulation = root.at("simulation");  // copied unread: the model is read first, because it determines the keys
  root.at("simulation").mark_read_deep();
  Scene scene;
  scene.model = read_model(root, directory);
  scene.duration = read_number(simulation, scene_key("duration"));
  scene.rate = read_number(simulation, scene_key("rate"));
  scene.step = read_number(simulation, scene_key("step"));
  scene.spectral_radius = read_number(simulation, scene_key("spectral_radius"));
  scene.refine = read_integer(simulation, scene_key("refine"));
  scene.seed = static_cast<std::uint64_t>(read_integer(simulation, scene_key("seed")));
  for (const LoadInput& input : load_topics(scene.model)) {
    scene.loads.push_back(read_load(simulation.at("loads").at(input.topic), input, directory));
  }
  const Value none = Value::map({}, simulation.path());
  const Value& sensors = simulation.has("sensors") ? simulation.at("sensors") : none;
  for (const ObservationSettings& observation : scene.model.observations) {
    const Value* map = sensors.has(observation.topic) ? &sensors.at(observation.topic) : nullptr;
    scene.sensors.push_back(read_sensor(map, observation, simulation.path() + ": sensors"));
  }
  simulation.require_all_read();
  return scene;
}

}  // namespace tissue_stiffness
