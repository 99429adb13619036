#include "forward/hyper_reduced_trajectory.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMaxIterations = 30;
constexpr int kPatience = 6;     // iterations before the Jacobian is renewed within a step
constexpr double kGrowth = 2.0;  // of a correction, at which iterations are taken to diverge
constexpr int kMaxHalvings = 10;

}  // namespace

HyperReducedTrajectory::HyperReducedTrajectory(const HyperReducedModel& reduced, const Eigen::VectorXd& theta, double start)
    : reduced_(reduced), system_(reduced, theta), alpha_(reduced.options().full.spectral_radius) {
  state_.time = start;
  state_.position = Eigen::VectorXd::Zero(system_.mass().rows());
  state_.rate = reduced.unit_velocity() * reduced.model().initial_velocity(theta);
  initialise();
}

HyperReducedTrajectory::HyperReducedTrajectory(const HyperReducedModel& reduced, const Eigen::VectorXd& theta,
                                               const HyperReducedTrajectory& from)
    : reduced_(reduced), system_(reduced, theta), alpha_(reduced.options().full.spectral_radius), state_(from.state_) {
  initialise();
}

void HyperReducedTrajectory::initialise() {
  system_.force(state_.time, state_.position, state_.rate, residual_);
  state_.acceleration = system_.mass().llt().solve(residual_);
  middle_ = state_;
}

void HyperReducedTrajectory::advance(double time) {
  const double span = time - state_.time;
  if (!(span > 0.0)) return;
  const int count = reduced_.steps(span);
  for (int k = 0; k < count; ++k) cut_step(span / count, 0);
  state_.time = time;
}

void HyperReducedTrajectory::cut_step(double step, int depth) {
  const State before = state_;
  try {
    if (try_step(step)) return;
  } catch (const NumericalError&) {  // a point turned inside out
  }
  state_ = before;
  if (depth == kMaxHalvings) {
    throw NumericalError("reduced time step at " + std::to_string(state_.time) + " s diverges, even cut to " +
                         std::to_string(step) + " s");
  }
  cut_step(0.5 * step, depth + 1);
  cut_step(0.5 * step, depth + 1);
}

// Computes the residual of the balance at the weighted instants for a displacement increment (GeneralizedAlpha).
void HyperReducedTrajectory::find_residual(double h, const Eigen::VectorXd& increment) {
  const State& s = state_;
  middle_.acceleration = (increment - h * s.rate) / (alpha_.beta * h * h) - (0.5 / alpha_.beta - 1.0) * s.acceleration;
  middle_.rate =
      s.rate + (1.0 - alpha_.alpha_f) * h * ((1.0 - alpha_.gamma) * s.acceleration + alpha_.gamma * middle_.acceleration);
  middle_.acceleration = (1.0 - alpha_.alpha_m) * middle_.acceleration + alpha_.alpha_m * s.acceleration;
  middle_.time = s.time + (1.0 - alpha_.alpha_f) * h;
  middle_.position = s.position + (1.0 - alpha_.alpha_f) * increment;
  system_.force(middle_.time, middle_.position, middle_.rate, residual_);
  residual_.noalias() -= system_.mass() * middle_.acceleration;
}

void HyperReducedTrajectory::factorize(double h) {
  system_.tangents(middle_.position, stiffness_, damping_);
  const double scale = 1.0 - alpha_.alpha_f;
  stiffness_ = scale * stiffness_ + (1.0 - alpha_.alpha_m) / (alpha_.beta * h * h) * system_.mass() +
               scale * alpha_.gamma / (alpha_.beta * h) * damping_;
  jacobian_.compute(stiffness_);
}

bool HyperReducedTrajectory::try_step(double h) {
  Eigen::VectorXd increment = h * state_.rate + 0.5 * h * h * state_.acceleration;
  double last = std::numeric_limits<double>::infinity(), rate = 1.0;
  for (int k = 0, since = 0; k < kMaxIterations; ++k, ++since) {
    find_residual(h, increment);
    if (k == 0) factorize(h);
    const Eigen::VectorXd correction = jacobian_.solve(residual_);
    const double size = correction.norm();
    if (!std::isfinite(size)) return false;
    if (k > 0 && (size > kGrowth * last || since >= kPatience)) {
      factorize(h);
      since = -1;
      last = std::numeric_limits<double>::infinity();
      continue;
    }
    if (std::isfinite(last)) rate = std::min(1.0, size / last);
    last = size;
    increment += correction;
    if (size * rate >= reduced_.tolerance()) continue;
    const State before = state_;
    state_.time += h;
    state_.acceleration =
        (increment - h * before.rate) / (alpha_.beta * h * h) - (0.5 / alpha_.beta - 1.0) * before.acceleration;
    state_.position += increment;
    state_.rate += h * ((1.0 - alpha_.gamma) * before.acceleration + alpha_.gamma * state_.acceleration);
    return true;
  }
  return false;
}

Eigen::VectorXd HyperReducedTrajectory::displacement() const {
  Eigen::VectorXd out(reduced_.basis().vectors.rows());
  reduced_.recover(state_.position, out);
  return out;
}

Eigen::VectorXd HyperReducedTrajectory::output() const {
  Eigen::MatrixXd out = Eigen::VectorXd::Zero(reduced_.model().output_size());
  reduced_.displacements(state_.position, out);
  return out;
}

Eigen::VectorXd HyperReducedTrajectory::velocity() const {
  Eigen::VectorXd out(reduced_.basis().vectors.rows());
  reduced_.recover(state_.rate, out);
  return out;
}

DynamicState HyperReducedTrajectory::balanced() const {
  const Eigen::Index n = reduced_.basis().vectors.rows();
  DynamicState out{middle_.time, Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), {}};
  reduced_.recover(middle_.position, out.displacement);
  reduced_.recover(middle_.rate, out.velocity);
  reduced_.recover(middle_.acceleration, out.acceleration);
  return out;
}

}  // namespace tissue_stiffness
