#include "estimation/input_linearisation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/ensemble.hpp"
#include "forward/load_error_response.hpp"
#include "forward/reduced_trajectory.hpp"
#include "types/least_squares.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostFrames = 150;   // used of a long recording, evenly spread
constexpr double kConstantStep = 0.5;      // of a tolerance, for its central difference
constexpr Eigen::Index kLowestModes = 6;   // modes along each of which the mesh's error is an unknown of its own
constexpr double kWholeError = 4.0 / 3.0;  // of what a mesh refined once changes, at second order

// Zeroes the rows for which the sensor or the model has no number.
void clean(InputLinearisation::Row& row) {
  for (Eigen::Index r = 0; r < row.error.size(); ++r) {
    const bool good = std::isfinite(row.error[r]) && std::isfinite(row.precision[r]) && row.parameters.row(r).allFinite() &&
                      row.constants.row(r).allFinite() && row.direct.row(r).allFinite() && row.modes.row(r).allFinite();
    if (good) continue;
    row.error[r] = row.precision[r] = 0.0;
    for (Eigen::MatrixXd* part : {&row.parameters, &row.constants, &row.direct, &row.modes}) part->row(r).setZero();
  }
}

Eigen::MatrixXd finite(const Eigen::MatrixXd& m) {
  return m.array().isFinite().select(m, 0.0);
}

// Returns the amplitudes of the modes that come closest to a change of the rows. A force at a tool sees none of them.
Eigen::VectorXd along_modes(const Eigen::MatrixXd& modes, const Eigen::VectorXd& precision, const Eigen::VectorXd& change) {
  const Eigen::VectorXd weight = finite(precision).cwiseSqrt();
  return least_squares(weight.asDiagonal() * finite(modes), weight.cwiseProduct(finite(change).col(0)));
}

}  // namespace

InputLinearisation::InputLinearisation(const MeshError::Question& question, InputModels& models)
    : q_(question),
      models_(models),
      p_(question.w.size()),
      size_(p_),
      force_noise_(models.base.settings().observations, question.frames) {
  const std::size_t stride = (question.frames.size() + kMostFrames - 1) / kMostFrames;
  for (std::size_t k = question.frames.size(); k > 0; k -= std::min(k, stride)) frames_.insert(frames_.begin(), k - 1);
  repeated_ = static_cast<double>(question.frames.size()) / static_cast<double>(frames_.size());
  const Eigen::MatrixXd& basis = models.linear_form().basis();
  motions_.resize(models.rigid.rows(), basis.cols() + models.rigid.cols());
  motions_ << basis, models.rigid;
  if (models.base.settings().exact_inputs) return;
  for (const auto& [topic, course] : models.uncertain.loads().courses()) add_load(topic, course);
  for (std::size_t i = 0; i < models.base.settings().observations.size(); ++i) add_pose(i);
  for (std::size_t i = 0; i < models.base.settings().observations.size(); ++i) add_force_sensor(i);
  if (question.mesh_changes.empty()) return;
  mesh_columns_ = kLowestModes + 1;
  size_ += mesh_columns_;
}

InputLinearisation::~InputLinearisation() {
  correct_loads(Eigen::VectorXd::Zero(size_));
}

void InputLinearisation::add_load(const std::string& topic, const std::shared_ptr<Course>& course) {
  course->correct({}, {});
  if (course->empty() || course->tolerance().exact()) return;
  const int components = course->acting();
  const auto measured = [&](double t) {
    Eigen::VectorXd load(components);
    for (int i = 0; i < components; ++i) load[i] = course->measured(t, i);
    return load;
  };
  LoadTolerance tolerance = course->tolerance();
  for (const FreeParameter& free : models_.base.parameters().free()) {
    if (free.name.find("force_scale") == 0) tolerance.gain = 0.0;  // a free force_scale is the gain itself
  }
  const LoadErrorBasis basis(tolerance, measured, components, q_.start, q_.frames.back().time);
  if (basis.size() == 0) return;
  loads_.push_back({topic, course, basis, size_});
  size_ += basis.size();
}

void InputLinearisation::add_pose(std::size_t source) {
  const ObservationSettings& sensor = models_.base.settings().observations[source];
  if (traits_of(sensor.kind).force || (sensor.rotation == 0.0 && sensor.offset == 0.0)) return;
  poses_.push_back({static_cast<int>(source), sensor.rotation, sensor.offset, size_});
  size_ += 6;
}

void InputLinearisation::add_force_sensor(std::size_t source) {
  const ObservationSettings& sensor = models_.base.settings().observations[source];
  if (!traits_of(sensor.kind).force) return;
  double bias = sensor.bias;
  for (const Frame& frame : q_.frames) {
    for (const Observation& observation : frame.observations) {
      if (sensor.bias >= 0.0 || observation.source != static_cast<int>(source)) continue;
      bias = std::max(bias, -sensor.bias * observation.points.col(0).norm());
    }
  }
  force_sensors_.push_back({static_cast<int>(source), sensor.gain, std::max(0.0, bias), sensor.rotation, size_});
  size_ += 7;
}

std::vector<InputGroup> InputLinearisation::groups() const {
  const auto topic = [&](int source) {
    return models_.base.settings().observations[static_cast<std::size_t>(source)].topic;
  };
  std::vector<InputGroup> out;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const Load& load = loads_[i];
    const bool motion = load.course->kind() == LoadInput::Kind::pose, pressure = load.basis.components() == 1;
    const std::string unit = motion ? "m" : pressure ? "Pa" : "N";
    for (const LoadErrorBasis::Group& group : load.basis.groups()) {
      out.push_back({load.topic, group.name, group.unit.empty() ? unit : group.unit, group.std, load.first + group.first,
                     group.count, static_cast<int>(i), pressure});
    }
  }
  for (const Pose& pose : poses_) {
    out.push_back({topic(pose.source), "pose offset", "m", pose.offset, pose.first, 3});
    out.push_back({topic(pose.source), "pose rotation", "rad", pose.rotation, pose.first + 3, 3});
  }
  for (const ForceSensor& sensor : force_sensors_) {
    out.push_back({topic(sensor.source), "gain", "-", sensor.gain, sensor.first, 1});
    out.push_back({topic(sensor.source), "bias", "N", sensor.bias, sensor.first + 1, 3});
    out.push_back({topic(sensor.source), "direction", "rad", sensor.rotation, sensor.first + 4, 3});
  }
  return out;
}

void InputLinearisation::correct_loads(const Eigen::VectorXd& z) {
  for (const Load& load : loads_) load.course->correct(load.basis, z.segment(load.first, load.basis.size()));
}

// Returns theta at the centre, at the sigma points around it, and with each varied constant to either side.
std::vector<Eigen::VectorXd> InputLinearisation::points(const Eigen::VectorXd& w, Constants constants) const {
  const Eigen::VectorXd centre = models_.base.parameters().theta(w);
  std::vector<Eigen::VectorXd> out{centre};
  for (const double side : {1.0, -1.0}) {
    for (Eigen::Index i = 0; i < p_; ++i) {
      Eigen::VectorXd moved = w;
      moved[i] += side * q_.spread[i];
      out.push_back(models_.base.parameters().theta(moved));
    }
  }
  for (const double side : {1.0, -1.0}) {
    if (constants == Constants::held) break;
    for (const UncertainConstant& constant : models_.constants) {
      if (constant.index == UncertainConstant::surface) continue;
      Eigen::VectorXd theta = centre;
      theta[constant.index] += side * kConstantStep * constant.std;
      out.push_back(std::move(theta));
    }
  }
  return out;
}

InputLinearisation::Row InputLinearisation::row(std::size_t index, const std::vector<Eigen::VectorXd>& thetas,
                                                const Eigen::MatrixXd& u, const Eigen::VectorXd& offset,
                                                const ReducedModes& modes, const Eigen::VectorXd& z) {
  const Frame& frame = q_.frames[index];
  const auto predict = [&](std::size_t i) {
    return predict_frame(models_.base, models_.operators, frame, thetas[i], u.col(static_cast<Eigen::Index>(i)));
  };
  const Prediction there = predict(0);
  const Eigen::Index rows = there.predicted.size();
  const auto np = static_cast<std::size_t>(p_), nc = (thetas.size() - 1) / 2 - np;
  Row out;
  out.parameters.resize(rows, p_);
  for (std::size_t i = 0; i < np; ++i) {
    const Eigen::VectorXd change = predict(1 + i).predicted - predict(1 + np + i).predicted;
    out.parameters.col(static_cast<Eigen::Index>(i)) = change / (2.0 * q_.spread[static_cast<Eigen::Index>(i)]);
  }
  out.constants.resize(rows, static_cast<Eigen::Index>(nc + (offset.size() > 0 ? 1 : 0)));
  for (std::size_t i = 0; i < nc; ++i) {
    const std::size_t high = 1 + 2 * np + i;
    out.constants.col(static_cast<Eigen::Index>(i)) =
        (predict(high).predicted - predict(high + nc).predicted) / (2.0 * kConstantStep);
  }
  if (offset.size() > 0) {
    const Prediction further_out = predict_frame(models_.base, models_.operators, frame, thetas[0], offset);
    out.constants.rightCols<1>() = (further_out.predicted - there.predicted) / models_.offset->tolerances;
  }
  const Eigen::MatrixXd& seen = motions_seen(frame, thetas[0], u.col(0));
  out.modes = modes_seen(frame, thetas[0], seen, modes);
  out.direct = Eigen::MatrixXd::Zero(rows, direct_columns());
  if (sensor_column_count() > 0) {
    out.direct.leftCols(sensor_column_count()) =
        sensor_columns(frame, there, u.col(0), seen.rightCols(models_.rigid.cols()));
  }
  if (mesh_columns_ > 0)
    out.direct.rightCols(mesh_columns_) = mesh_columns(index, out.modes, force_noise_.precision(frame, there));
  Prediction corrected = there;
  corrected.predicted += out.direct * z.tail(direct_columns());
  out.nodes = there.nodes;
  out.places = there.places;
  out.error = there.measured - corrected.predicted;
  out.forces = force_noise_.note(frame, corrected, out.error);
  out.precision = force_noise_.precision(frame, corrected);
  clean(out);
  return out;
}

// A force sensor sees the elastic force of each mode, and what else is in the reaction.
Eigen::MatrixXd InputLinearisation::modes_seen(const Frame& frame, const Eigen::VectorXd& theta,
                                               const Eigen::MatrixXd& seen, const ReducedModes& modes) const {
  const Eigen::Index own = modes.shapes.cols(), forces = models_.base.output_size() - models_.base.fem().dof_count();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(seen.rows(), own + forces);
  out.leftCols(own) = seen.leftCols(modes.shapes.rows()) * modes.shapes;
  if (forces == 0) return out;
  const Eigen::MatrixXd elastic = models_.linear_form().reaction_rows(theta, modes).elastic;
  Eigen::Index first = 0;
  for (const Observation& observation : frame.observations) {
    for (std::size_t r = 0; r < models_.base.reactions().size() && traits_of(observation.kind).force; ++r) {
      const ObservationSettings& sensor =
          models_.base.settings().observations[static_cast<std::size_t>(observation.source)];
      if (models_.base.reactions()[r].region != sensor.region) continue;
      const Eigen::Index column = 3 * static_cast<Eigen::Index>(r);
      out.block(first, 0, 3, own) = elastic.middleCols<3>(column).transpose();
      out.block<3, 3>(first, own + column).setIdentity();
    }
    first += observation.row_count();
  }
  return out;
}

// Displacements of named nodes are linear in the motion, and most frames see these nodes again.
const Eigen::MatrixXd& InputLinearisation::motions_seen(const Frame& frame, const Eigen::VectorXd& theta,
                                                        const Eigen::VectorXd& u) {
  const auto seen = [&] { return predict_along(models_.base, models_.operators, frame, theta, u, motions_); };
  if (models_.base.nonlinear() || !sees_named_nodes(models_.base, frame)) return seen_ = seen();
  std::vector<int> key;
  for (const Observation& observation : frame.observations) {
    key.push_back(observation.source);
    key.push_back(static_cast<int>(observation.ids.size()));
    key.insert(key.end(), observation.ids.data(), observation.ids.data() + observation.ids.size());
  }
  const auto known = named_.find(key);
  return known != named_.end() ? known->second : named_.emplace(std::move(key), seen()).first->second;
}

Eigen::MatrixXd InputLinearisation::sensor_columns(const Frame& frame, const Prediction& there, const Eigen::VectorXd& u,
                                                   const Eigen::MatrixXd& rigid) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rigid.rows(), sensor_column_count());
  const Eigen::Index poses = 6 * static_cast<Eigen::Index>(poses_.size());
  Eigen::Index first = 0;
  for (const Observation& observation : frame.observations) {
    const Eigen::Index count = observation.row_count();
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      if (poses_[k].source != observation.source) continue;
      const Eigen::Index column = 6 * static_cast<Eigen::Index>(k);
      const auto& sensor = *models_.operators[static_cast<std::size_t>(observation.source)];
      const std::optional<Eigen::MatrixXd> own = sensor.pose_tangent(observation, u);
      const Eigen::MatrixXd pose = own ? *own : rigid.middleRows(first, count);
      out.block(first, column, count, 3) = poses_[k].offset * pose.leftCols<3>();
      out.block(first, column + 3, count, 3) = poses_[k].rotation * pose.rightCols<3>();
    }
    for (std::size_t k = 0; k < force_sensors_.size(); ++k) {
      const ForceSensor& sensor = force_sensors_[k];
      if (sensor.source != observation.source) continue;
      const Eigen::Index column = poses + 7 * static_cast<Eigen::Index>(k);
      const Eigen::Vector3d force = there.predicted.segment<3>(first);
      out.block<3, 1>(first, column) = sensor.gain * force;
      out.block<3, 3>(first, column + 1) = sensor.bias * Eigen::Matrix3d::Identity();
      for (int axis = 0; axis < 3; ++axis)
        out.block<3, 1>(first, column + 4 + axis) = sensor.rotation * Eigen::Vector3d::Unit(axis).cross(force);
    }
    first += count;
  }
  return out;
}

// The mesh's change is divided into its share along each of the lowest modes and the rest. The errors of a mesh differ from
// mode to mode, so what a refinement leaves is not its whole change times one number.
Eigen::MatrixXd InputLinearisation::mesh_columns(std::size_t frame, const Eigen::MatrixXd& modes,
                                                 const Eigen::VectorXd& precision) const {
  const Eigen::Index rows = modes.rows(), count = std::min({kLowestModes, modes.cols(), rows});
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, mesh_columns_);
  Eigen::VectorXd change = kWholeError * q_.mesh_changes[frame];
  if (change.size() != rows) return out;
  change = finite(change);
  const Eigen::MatrixXd lowest = finite(modes.leftCols(count));
  const Eigen::VectorXd share = along_modes(lowest, precision, change);
  out.leftCols(count) = lowest * share.asDiagonal();
  out.col(mesh_columns_ - 1) = change - lowest * share;
  return out;
}

// Visits every used frame, linearised at z, with the modal amplitudes of the loads' errors.
void InputLinearisation::each_row(const Eigen::VectorXd& z, Constants constants, const Visitor& visit) {
  force_noise_.start_run();
  correct_loads(z);
  const std::vector<Eigen::VectorXd> thetas = points(z.head(p_), constants);
  const auto all = models_.runs->start_all(thetas, q_.start);
  std::unique_ptr<Trajectory> further_out;
  if (models_.offset && constants == Constants::varied) {
    models_.offset->drive_like(models_.uncertain);
    further_out = models_.offset->runs->start(thetas[0], q_.start);
  }
  Eigen::VectorXd offset;
  std::vector<LoadErrorResponse> responses;
  for (const Load& load : loads_)
    responses.emplace_back(models_.linear_form(), thetas[0], q_.start, load.course, load.basis);
  const ReducedTrajectory at_rest(models_.linear_form(), thetas[0], q_.start);
  const ReducedModes& modes = *at_rest.modes();
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(models_.base.output_size(), static_cast<Eigen::Index>(thetas.size()));
  const Eigen::Index own = modes.shapes.cols(), forces = u.rows() - models_.base.fem().dof_count();
  Eigen::MatrixXd amplitudes(own + forces, load_columns());
  for (const std::size_t index : frames_) {
    q_.checkpoint();
    std::vector<double> times;
    times.reserve(thetas.size());
    for (const Eigen::VectorXd& theta : thetas)
      times.push_back(q_.frames[index].time - models_.base.sensors().delay(theta));
    all->advance(times);
    all->outputs(u);
    if (further_out) {
      further_out->advance(times[0]);
      offset = further_out->output();
    }
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      responses[i].advance(times[0]);
      // The measured load is too large by B eta, so the motion under the true one is smaller.
      auto columns = amplitudes.middleCols(loads_[i].first - p_, loads_[i].basis.size());
      columns.topRows(own) = -responses[i].amplitudes();
      columns.bottomRows(forces) = -responses[i].further_reactions();
    }
    visit(row(index, thetas, u, offset, modes, z), amplitudes);
  }
}

NormalEquations InputLinearisation::at(const Eigen::VectorXd& z, Constants constants) {
  NormalEquations out(size_, static_cast<Eigen::Index>(models_.constants.size()));
  const Eigen::Index l = load_columns(), c = size_ - p_ - l;
  each_row(z, constants, [&](const Row& row, const Eigen::MatrixXd& amplitudes) {
    Eigen::MatrixXd own(row.error.size(), p_ + c);
    own << row.parameters, row.direct;
    const Eigen::MatrixXd weighted = row.precision.asDiagonal() * own, seen = row.precision.asDiagonal() * row.modes;
    const Eigen::MatrixXd direct = weighted.transpose() * own;
    const Eigen::MatrixXd across = (weighted.transpose() * row.modes) * amplitudes;
    const Eigen::VectorXd pull = weighted.transpose() * row.error;
    out.information.topLeftCorner(p_, p_) += direct.topLeftCorner(p_, p_);
    out.information.topRightCorner(p_, c) += direct.topRightCorner(p_, c);
    out.information.bottomRightCorner(c, c) += direct.bottomRightCorner(c, c);
    out.information.block(0, p_, p_, l) += across.topRows(p_);
    out.information.block(p_, p_ + l, l, c) += across.bottomRows(c).transpose();
    out.information.block(p_, p_, l, l).noalias() += amplitudes.transpose() * ((seen.transpose() * row.modes) * amplitudes);
    out.gradient.head(p_) += pull.head(p_);
    out.gradient.tail(c) += pull.tail(c);
    out.gradient.segment(p_, l) += amplitudes.transpose() * (seen.transpose() * row.error);
    out.cost += row.error.dot(row.precision.cwiseProduct(row.error));
    out.rows += static_cast<double>((row.precision.array() > 0.0).count());
    if (constants == Constants::held) return;
    const Eigen::MatrixXd across_constants = weighted.transpose() * row.constants;
    out.constants.topRows(p_) += across_constants.topRows(p_);
    out.constants.bottomRows(c) += across_constants.bottomRows(c);
    out.constants.middleRows(p_, l) += amplitudes.transpose() * (seen.transpose() * row.constants);
    const Eigen::MatrixXd weighted_constants = row.precision.asDiagonal() * row.constants;
    out.constants_information += weighted_constants.transpose() * row.constants;
    out.constants_gradient += weighted_constants.transpose() * row.error;
  });
  out.force_noise = force_noise_.found();
  out.information.triangularView<Eigen::StrictlyLower>() = out.information.transpose();
  out.repeat(repeated_);
  return out;
}

}  // namespace tissue_stiffness
