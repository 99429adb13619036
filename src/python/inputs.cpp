#include "python/inputs.hpp"

#include <cmath>
#include <sstream>
#include <utility>

#include "forward/model.hpp"
#include "python/arrays.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

constexpr double kRotation = 1e-6;  // largest error of a rotation's orthogonality

std::string at(const std::string& topic, double time) {
  std::ostringstream text;
  text.precision(12);
  text << topic << " at " << time << " s";
  return text.str();
}

void require_time(double time) {
  if (!std::isfinite(time)) throw InputError("stamp", std::to_string(time), "a finite time [s]");
}

template <typename Items>
std::string topics(const Items& items) {
  std::string names;
  for (const auto& item : items) names += (names.empty() ? "" : ", ") + item.topic;
  return names.empty() ? "none, because the model has none" : names;
}

Eigen::VectorXd pose(const Eigen::VectorXd& numbers, const std::string& where) {
  const char* allowed = "a matrix of shape (4, 4): rotation and position [m], and 0 0 0 1";
  if (numbers.size() != 16) throw InputError(where, std::to_string(numbers.size()) + " numbers", allowed);
  Eigen::Isometry3d pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d rotation = pose.linear();
  const bool orthogonal = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kRotation;
  if (!orthogonal || rotation.determinant() < 0.0 || pose.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw InputError(where, "a matrix that is no pose", allowed);
  }
  return pose_values(pose);
}

}  // namespace

std::vector<LoadInput> load_inputs(const ModelSettings& settings, const TetMesh& mesh) {
  return Model(settings, mesh).loads().inputs();
}

Inputs::Inputs(const ModelSettings& settings, const TetMesh& mesh, std::vector<LoadInput> loads)
    : sensors_(settings.observations), loads_(std::move(loads)), vertices_(mesh.corner_count) {}

int Inputs::source(const py::object& topic) const {
  if (topic.is_none()) {
    if (sensors_.size() == 1) return 0;
    throw InputError("topic", "none", topics(sensors_));
  }
  const std::string name = py::str(topic);
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    if (sensors_[i].topic == name) return static_cast<int>(i);
  }
  throw InputError("topic", name, topics(sensors_));
}

void Inputs::require_ids(const Observation& observation, const std::string& where) const {
  if (!traits_of(observation.kind).identified || observation.tracks) return;
  const ObservationSettings& sensor = sensors_[static_cast<std::size_t>(observation.source)];
  const bool markers = observation.kind == ObservationKind::markers;
  const int count = markers ? static_cast<int>(sensor.rest.cols()) : vertices_;
  if (observation.ids.size() != observation.points.cols()) {
    throw InputError(
        where, std::to_string(observation.ids.size()) + " for " + std::to_string(observation.points.cols()) + " points",
        "one index for each point");
  }
  for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
    const int id = observation.ids[i];
    if (id < 0 || id >= count) {
      throw InputError(where, std::to_string(id) + " in row " + std::to_string(i), "0 to " + std::to_string(count - 1));
    }
  }
}

Observation Inputs::observation(const py::object& topic, double time, const py::object& points,
                                const py::object& ids) const {
  require_time(time);
  Observation out;
  out.source = source(topic);
  out.time = time;
  const ObservationSettings& sensor = sensors_[static_cast<std::size_t>(out.source)];
  const ObservationTraits& traits = traits_of(sensor.kind);
  const std::string where = at(sensor.topic, time);
  out.kind = sensor.kind;
  if (traits.image) throw InputError(where, "an array", "a recording: what images show comes from them");
  if (traits.force) {
    const Eigen::VectorXd force = to_numbers(points, where + ": points");
    if (force.size() != 3)
      throw InputError(where + ": points", std::to_string(force.size()) + " numbers", "a force (3,) [N]");
    out.points = force;
  } else {
    out.points = to_points(points, where + ": points");
  }
  const std::string ids_key = where + ": ids";
  if (!traits.identified) {
    if (!ids.is_none()) throw InputError(ids_key, "indices", "none: these points have no identity");
  } else if (ids.is_none()) {
    const int all = sensor.kind == ObservationKind::markers ? static_cast<int>(sensor.rest.cols()) : vertices_;
    if (out.points.cols() != all) {
      throw InputError(ids_key, "none for " + std::to_string(out.points.cols()) + " points",
                       "one index for each point, or all " + std::to_string(all) + " points in order");
    }
    out.ids = Eigen::VectorXi::LinSpaced(all, 0, all - 1);
  } else {
    out.ids = to_indices(ids, ids_key);
  }
  require_ids(out, ids_key);
  return out;
}

LoadSample Inputs::load(const std::string& topic, double time, const py::object& value) const {
  require_time(time);
  for (const LoadInput& input : loads_) {
    if (input.topic != topic) continue;
    const std::string where = at(topic, time);
    Eigen::VectorXd numbers = to_numbers(value, where);
    if (input.kind == LoadInput::Kind::pose) return {topic, time, pose(numbers, where)};
    const bool wrench = input.kind == LoadInput::Kind::wrench;
    if (wrench && numbers.size() == 3) numbers.conservativeResizeLike(Eigen::VectorXd::Zero(6));
    if (numbers.size() != component_count(input.kind)) {
      throw InputError(where, std::to_string(numbers.size()) + " numbers",
                       wrench ? "a force (3,) [N], or force and torque (6,) [N, N m]" : "a pressure [Pa]");
    }
    return {topic, time, numbers};
  }
  throw InputError("load", topic, topics(loads_));
}

Frame Inputs::frame(double time, std::vector<Observation> observations) const {
  require_time(time);
  for (const Observation& observation : observations) {
    const auto source = static_cast<std::size_t>(observation.source);
    if (source >= sensors_.size() || sensors_[source].kind != observation.kind) {
      throw InputError("observations",
                       traits_of(observation.kind).name + (" of entry " + std::to_string(observation.source)),
                       "what this model observes: " + topics(sensors_));
    }
    require_ids(observation, at(sensors_[source].topic, time) + ": ids");
  }
  return {time, std::move(observations)};
}

}  // namespace tissue_stiffness
