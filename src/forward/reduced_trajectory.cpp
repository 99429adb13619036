#include "tissue_stiffness/forward/reduced_trajectory.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace tissue_stiffness {
namespace {

constexpr double kLoadStep = 0.004;  // [s] at most between two looks at a measured load
constexpr double kSameStep = 1e-11;  // [s]

}  // namespace

ReducedTrajectory::ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start)
    : reduced_(reduced), theta_(theta), time_(start) {
  const Model& model = reduced.model_;
  const Eigen::Index m = reduced.basis_.cols();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(m, m), stiffness = mass;
  Eigen::MatrixX3d uniform = Eigen::MatrixX3d::Zero(m, 3);
  for (std::size_t p = 0; p < model.parts().size(); ++p) {
    const auto& part = model.parts()[p];
    const auto values = part.parameters(theta);
    for (std::size_t i = 0; i < part.terms.mass.size(); ++i) {
      const double c = part.terms.mass[i].coefficient(values);
      mass += c * reduced.mass_[p][i];
      uniform += c * reduced.uniform_[p][i];
    }
    for (std::size_t i = 0; i < part.terms.stiffness.size(); ++i) {
      stiffness += part.terms.stiffness[i].coefficient(values) * reduced.stiffness_[p][i];
    }
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(stiffness, mass);
  modes_ = eigen.eigenvectors();
  to_modal_ = modes_.transpose() * mass;
  omega_ = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  damping_ = model.mass_damping(theta) + model.stiffness_damping(theta) * omega_.array().square();
  constant_force_ = modes_.transpose() * (uniform * model.body_acceleration(theta));
  q_ = Eigen::VectorXd::Zero(m);
  v_ = modes_.transpose() * (uniform * model.initial_velocity(theta));
  for (std::size_t p = 0; p < model.parts().size(); ++p) {
    const auto& part = model.parts()[p];
    for (std::size_t i = 0; i < part.terms.loads.size(); ++i) {
      load_terms_.push_back(&part.terms.loads[i]);
      load_modes_.conservativeResize(m, load_modes_.cols() + 1);
      load_modes_.rightCols<1>() =
          part.terms.loads[i].coefficient(part.parameters(theta)) * (modes_.transpose() * reduced.loads_[p][i]);
    }
  }
  force_ = modal_force(start);
}

Eigen::VectorXd ReducedTrajectory::modal_force(double time) const {
  Eigen::VectorXd f = constant_force_;
  for (std::size_t i = 0; i < load_terms_.size(); ++i) {
    const LoadTerm& term = *load_terms_[i];
    const double value = term.course ? term.course->value(time, term.component) : 1.0;
    f += value * load_modes_.col(static_cast<Eigen::Index>(i));
  }
  return f;
}

// [q v f f']' as one linear system; its exponential carries all four over the step.
void ReducedTrajectory::set_step(double step) {
  if (std::abs(step - step_) < kSameStep) return;
  step_ = step;
  const Eigen::Index m = q_.size();
  Transition& t = transition_;
  for (Eigen::ArrayXd* array : {&t.qq, &t.qv, &t.qf0, &t.qf1, &t.vq, &t.vv, &t.vf0, &t.vf1}) array->resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 1) = step;
    a(1, 0) = -omega_[i] * omega_[i] * step;
    a(1, 1) = -damping_[i] * step;
    a(1, 2) = step;
    a(2, 3) = 1.0;  // f grows by its increment over the step
    const Eigen::Matrix4d e = a.exp();
    t.qq[i] = e(0, 0), t.qv[i] = e(0, 1), t.qf1[i] = e(0, 3), t.qf0[i] = e(0, 2) - e(0, 3);
    t.vq[i] = e(1, 0), t.vv[i] = e(1, 1), t.vf1[i] = e(1, 3), t.vf0[i] = e(1, 2) - e(1, 3);
  }
}

ReducedTrajectory::FreeMotion ReducedTrajectory::free_motion(double span, int count) const {
  FreeMotion m;
  for (Eigen::ArrayXd* array : {&m.qq, &m.qv, &m.vq, &m.vv}) array->resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Matrix2d a;
    a << 0.0, span, -omega_[i] * omega_[i] * span, -damping_[i] * span;
    const Eigen::Matrix2d e = a.exp();
    m.qq[i] = e(0, 0), m.qv[i] = e(0, 1), m.vq[i] = e(1, 0), m.vv[i] = e(1, 1);
  }
  return m;
}

void ReducedTrajectory::correct(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity) {
  q_ += to_modal_ * displacement;
  v_ += to_modal_ * velocity;
}

void ReducedTrajectory::advance(double time) {
  const double span = time - time_;
  if (!(span > 0.0)) return;
  const int steps = load_terms_.empty() ? 1 : static_cast<int>(std::ceil(span / kLoadStep));
  set_step(span / steps);
  const double start = time_;
  for (int k = 1; k <= steps; ++k) {
    const double now = k == steps ? time : start + step_ * k;
    const Eigen::VectorXd force = modal_force(now);
    const Transition& t = transition_;
    const Eigen::ArrayXd q = t.qq * q_.array() + t.qv * v_.array() + t.qf0 * force_.array() + t.qf1 * force.array();
    v_ = (t.vq * q_.array() + t.vv * v_.array() + t.vf0 * force_.array() + t.vf1 * force.array()).matrix();
    q_ = q.matrix();
    force_ = force;
    time_ = now;
  }
}

}  // namespace tissue_stiffness
