#include "forward/reduced_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr int kSlopeSamples = 6;
constexpr double kSlopeStep = 0.01;  // [s] between the samples of a load's rate
constexpr double kLoadStep = 0.004;  // [s] at most between two evaluations of a load

}  // namespace

ReducedTrajectory::ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start,
                                     bool half_basis)
    : reduced_(reduced),
      time_(start),
      load_factor_(reduced.model().load_factor(theta)),
      modes_(reduced.modes(theta, half_basis)),
      constant_force_(modes_->weight * reduced.model().body_acceleration(theta)),
      mass_damping_(reduced.model().mass_damping(theta)),
      stiffness_damping_(reduced.model().stiffness_damping(theta)),
      branches_(reduced.model().relaxations(theta)),
      damping_(modes_->damping(mass_damping_, stiffness_damping_)),
      step_(modes_->square, damping_, branches_),
      state_(Eigen::MatrixXd::Zero(modes_->square.size(), step_.states())) {
  state_.col(1) = modes_->momentum * reduced.model().initial_velocity(theta);
  collect_loads(theta);
  force_ = modal_force(start);
  if (reduced.model().starts_in_motion()) set_in_motion(reduced.model().initial_motion(theta));
  for (Prescribed& motion : prescribed_) begin(motion);
}

ReducedTrajectory::ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta,
                                     const ReducedTrajectory& from)
    : ReducedTrajectory(reduced, theta, from.time_) {
  const Eigen::Index shared = std::min(state_.cols(), from.state_.cols());
  state_.leftCols(shared) = modes_->to_modal * (from.modes_->shapes * from.state_.leftCols(shared));
  for (Eigen::Index branch = shared; branch < state_.cols(); ++branch) state_.col(branch) = state_.col(0);  // relaxed
  if (branches_.size() != from.branches_.size() || prescribed_.size() != from.prescribed_.size()) return;
  for (std::size_t i = 0; i < prescribed_.size(); ++i) prescribed_[i].relaxed = from.prescribed_[i].relaxed;
}

void ReducedTrajectory::set_in_motion(const InitialMotion& initial) {
  const Eigen::MatrixXd shapes = modes_->to_modal * reduced_.start_shapes();
  state_.col(0) += initial.equilibrium * modes_->flexibility().cwiseProduct(force_) + shapes * initial.displacement;
  state_.col(1) += initial.equilibrium * modes_->flexibility().cwiseProduct(modal_force_rate()) + shapes * initial.velocity;
  for (Eigen::Index branch = 2; branch < state_.cols(); ++branch) state_.col(branch) = state_.col(0);  // relaxed
}

void ReducedTrajectory::collect_loads(const Eigen::VectorXd& theta) {
  const auto& parts = reduced_.model().parts();
  reaction_rows_ = reduced_.reaction_rows(theta, *modes_);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<LoadTerm>& terms = parts[p].terms.loads;
    if (terms.empty()) continue;
    const Eigen::VectorXd own = parts[p].parameters(theta);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double c = terms[i].coefficient(own);
      if (c == 0.0) continue;
      Load load{&terms[i], own, c * (modes_->shapes.transpose() * reduced_.load(p, i, own))};
      if (terms[i].prescribed) {
        prescribed_.push_back({std::move(load)});
      } else {
        loads_.push_back(std::move(load));
      }
    }
  }
}

Eigen::VectorXd ReducedTrajectory::modal_force(double time) const {
  Eigen::VectorXd f = constant_force_;
  for (const Load& load : loads_) {
    if (const double now = value(load, time); now != 0.0) f += now * load.modal;
  }
  return f;
}

// The slope of a line through the first forces, because measured loads are noisy.
Eigen::VectorXd ReducedTrajectory::modal_force_rate() const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(force_.size());
  double squares = 0.0;
  for (int k = 0; k < kSlopeSamples; ++k) {
    const double from_middle = kSlopeStep * (k - 0.5 * (kSlopeSamples - 1));
    sum += from_middle * modal_force(time_ + kSlopeStep * k);
    squares += from_middle * from_middle;
  }
  return sum / squares;
}

void ReducedTrajectory::begin(Prescribed& motion) const {
  motion.motion = motion.after = value(motion.load, time_);
  motion.relaxed = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(branches_.size()), motion.motion);
}

// Goes on to `time`, a step later. The motion is linear over the step.
void ReducedTrajectory::follow(Prescribed& motion, double time, double step) const {
  const double from = motion.motion, to = value(motion.load, time), rate = (to - from) / step;
  motion.before = from + stiffness_damping_ * rate;
  motion.after = to + stiffness_damping_ * rate;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const Relaxation& branch = branches_[b];
    double& z = motion.relaxed[static_cast<Eigen::Index>(b)];
    const double lag = branch.time_constant * rate;
    motion.before += branch.modulus * (from - z);
    z = to - lag + (z - from + lag) * std::exp(-step / branch.time_constant);
    motion.after += branch.modulus * (to - z);
  }
  motion.motion = to;
}

// A motion that is linear between samples jolts the body at each of them. So the mean inertia of a step counts. That of
// slow modes is extrapolated from the middle of the last two steps to the end of the last.
Eigen::VectorXd ReducedTrajectory::inertia() const {
  if (last_.step == 0.0) return Eigen::VectorXd::Zero(state_.rows());
  Eigen::VectorXd out = last_.mean;
  if (before_last_.step == 0.0) return out;
  const double share = last_.step / (last_.step + before_last_.step);
  for (Eigen::Index m = 0; m < out.size(); ++m) {
    if (!fast(m)) out[m] += share * (last_.mean[m] - before_last_.mean[m]);
  }
  return out;
}

// Modes that are faster than the steps ring after each jolt, which no sensor shows. Their stretch is the one that goes with
// their mean inertia, (f - q'' - alpha q') / omega^2.
Eigen::VectorXd ReducedTrajectory::reactions_with(const Eigen::MatrixXd& further) const {
  if (reaction_rows_.lift.size() == 0) return {};
  const Eigen::VectorXd inert = inertia();
  Eigen::VectorXd stretched = step_.stretch(state_, stiffness_damping_);
  for (Eigen::Index m = 0; m < inert.size(); ++m) {
    if (fast(m)) stretched[m] = (whole_force_[m] - inert[m]) / modes_->square[m];
  }
  Eigen::VectorXd out = reaction_rows_.lift.transpose() * (inert - force_) + reaction_rows_.elastic.transpose() * stretched;
  // An extra force is internal: what it changes shows in the region's springs.
  if (further.size() > 0)
    out -= reaction_rows_.lift.transpose() * modes_->square.cwiseProduct(step_.stretch(further, stiffness_damping_));
  return out;
}

Eigen::VectorXd ReducedTrajectory::output() const {
  Eigen::VectorXd out(reduced_.model().output_size());
  const Eigen::VectorXd forces = reactions();
  out << displacement(), forces;
  return out;
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

void ReducedTrajectories::outputs(Eigen::MatrixXd& out) const {
  reduced_.displacements(coordinates(), out);
  const Eigen::Index forces = out.rows() - reduced_.basis().rows();
  for (std::size_t i = 0; forces > 0 && i < runs_.size(); ++i) {
    out.col(static_cast<Eigen::Index>(i)).tail(forces) = static_cast<const ReducedTrajectory&>(*runs_[i]).reactions();
  }
}

void ReducedTrajectory::advance(double time) {
  const double span = time - time_;
  if (!(span > 0.0)) return;
  const bool loaded = !loads_.empty() || !prescribed_.empty();
  const int steps = loaded ? static_cast<int>(std::ceil(span / kLoadStep)) : 1;
  const double start = time_, step = span / steps;
  for (int k = 1; k <= steps; ++k) {
    const double now = k == steps ? time : start + step * k;
    const Eigen::VectorXd force = modal_force(now);
    if (prescribed_.empty()) {
      step_.advance(step, force_, force, state_);
    } else {
      Eigen::VectorXd before = force_, after = force;
      for (Prescribed& motion : prescribed_) {
        follow(motion, now, step);
        before += motion.before * motion.load.modal;
        after += motion.after * motion.load.modal;
      }
      const Eigen::VectorXd momentum = state_.col(1) + mass_damping_ * state_.col(0);
      step_.advance(step, before, after, state_);
      before_last_ = std::move(last_);
      last_ = {(state_.col(1) + mass_damping_ * state_.col(0) - momentum) / step, step};
      whole_force_ = after;
    }
    force_ = force;
    time_ = now;
  }
}

}  // namespace tissue_stiffness
