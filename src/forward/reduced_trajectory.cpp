#include "forward/reduced_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace tissue_stiffness {
namespace {

constexpr double kLoadStep = 0.004;  // [s] at most between two evaluations of a load

}  // namespace

ReducedTrajectory::ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start,
                                     bool half_basis)
    : reduced_(reduced),
      time_(start),
      load_factor_(reduced.model().load_factor(theta)),
      modes_(reduced.modes(theta, half_basis)),
      constant_force_(modes_->weight * reduced.model().body_acceleration(theta)),
      damping_(modes_->damping(reduced.model().mass_damping(theta), reduced.model().stiffness_damping(theta))),
      step_(modes_->square, damping_, reduced.model().relaxations(theta)),
      state_(Eigen::MatrixXd::Zero(modes_->square.size(), step_.states())) {
  state_.col(1) = modes_->momentum * reduced.model().initial_velocity(theta);
  collect_loads(theta);
  force_ = modal_force(start);
}

ReducedTrajectory::ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta,
                                     const ReducedTrajectory& from)
    : ReducedTrajectory(reduced, theta, from.time_) {
  const Eigen::Index shared = std::min(state_.cols(), from.state_.cols());
  state_.leftCols(shared) = modes_->to_modal * (from.modes_->shapes * from.state_.leftCols(shared));
  for (Eigen::Index branch = shared; branch < state_.cols(); ++branch) state_.col(branch) = state_.col(0);  // relaxed
}

void ReducedTrajectory::collect_loads(const Eigen::VectorXd& theta) {
  const auto& parts = reduced_.model().parts();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<LoadTerm>& terms = parts[p].terms.loads;
    if (terms.empty()) continue;
    const Eigen::VectorXd own = parts[p].parameters(theta);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double c = terms[i].coefficient(own);
      if (c == 0.0) continue;
      loads_.push_back({&terms[i], own, c * (modes_->shapes.transpose() * reduced_.load(p, i, own))});
    }
  }
}

Eigen::VectorXd ReducedTrajectory::modal_force(double time) const {
  Eigen::VectorXd f = constant_force_;
  for (const Load& load : loads_) {
    const double value = reduced_.model().loads().value(*load.term, load.parameters, load_factor_, time);
    if (value != 0.0) f += value * load.modal;
  }
  return f;
}

ReducedTrajectory::FreeMotion ReducedTrajectory::free_motion(double span, int count) const {
  FreeMotion m;
  for (Eigen::ArrayXd* array : {&m.qq, &m.qv, &m.vq, &m.vv}) array->resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Matrix2d a;
    a << 0.0, span, -modes_->square[i] * span, -damping_[i] * span;
    const Eigen::Matrix2d e = a.exp();
    m.qq[i] = e(0, 0), m.qv[i] = e(0, 1), m.vq[i] = e(1, 0), m.vv[i] = e(1, 1);
  }
  return m;
}

void ReducedTrajectory::correct(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity) {
  state_.col(0) += modes_->to_modal * displacement;
  state_.col(1) += modes_->to_modal * velocity;
}

Eigen::MatrixXd ReducedTrajectories::coordinates() const {
  Eigen::MatrixXd all(reduced_.basis().cols(), static_cast<Eigen::Index>(runs_.size()));
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    all.col(static_cast<Eigen::Index>(i)) = static_cast<const ReducedTrajectory&>(*runs_[i]).coordinates();
  }
  return all;
}

void ReducedTrajectory::advance(double time) {
  const double span = time - time_;
  if (!(span > 0.0)) return;
  const int steps = loads_.empty() ? 1 : static_cast<int>(std::ceil(span / kLoadStep));
  const double start = time_, step = span / steps;
  for (int k = 1; k <= steps; ++k) {
    const double now = k == steps ? time : start + step * k;
    const Eigen::VectorXd force = modal_force(now);
    step_.advance(step, force_, force, state_);
    force_ = force;
    time_ = now;
  }
}

}  // namespace tissue_stiffness
