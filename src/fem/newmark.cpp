#include "tissue_stiffness/fem/newmark.hpp"

#include <cmath>
#include <limits>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMaxIterations = 40;
constexpr int kMaxHalvings = 10;
constexpr double kSlow = 0.6;  // a contraction worse than this asks for a fresh factor
constexpr std::size_t kMostUpdates = 12;
constexpr double kFlat = 1e-8;      // relative curvature below which an update says nothing
constexpr double kSameStep = 1e-3;  // relative change of the step that a factor survives

void zero_fixed(Eigen::VectorXd& x, const std::vector<char>& fixed) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) x[i] = 0.0;
  }
}

}  // namespace

Newmark::Newmark(const DynamicSystem& system, double spectral_radius, double tolerance)
    : system_(system), tolerance_(tolerance) {
  if (spectral_radius < 1.0) {
    alpha_m_ = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
    alpha_f_ = spectral_radius / (spectral_radius + 1.0);
    gamma_ = 0.5 - alpha_m_ + alpha_f_;
    beta_ = 0.25 * std::pow(1.0 - alpha_m_ + alpha_f_, 2);
  }
}

const std::vector<Relaxation>& DynamicSystem::relaxations() const {
  static const std::vector<Relaxation> none;
  return none;
}

void Newmark::initialise(DynamicState& state) const {
  state.relaxed.assign(system_.relaxations().size(), state.displacement);
  Eigen::VectorXd f = system_.force(state.time, state.displacement, state.velocity);
  if (system_.damped()) f -= system_.damping() * state.velocity;
  zero_fixed(f, system_.fixed());
  SparseMatrix mass = system_.mass();
  fix_dofs(mass, system_.fixed(), mass.diagonal().mean());
  SparseSolver solver;
  solver.factorize(mass);
  state.acceleration = solver.solve(f);
}

void Newmark::step(DynamicState& state, double step) {
  cut_step(state, step, 0);
}

void Newmark::cut_step(DynamicState& state, double step, int depth) {
  if (try_step(state, step)) return;
  if (depth == kMaxHalvings) {
    throw NumericalError("time step at " + std::to_string(state.time) + " s diverges, even cut to " + std::to_string(step) +
                         " s");
  }
  DynamicState half = state;
  cut_step(half, 0.5 * step, depth + 1);
  cut_step(half, 0.5 * step, depth + 1);
  state = std::move(half);
}

// Residual of the balance at the weighted instants for the displacement increment x; `middle` gets the state at 1 -
// alpha_f.
Eigen::VectorXd Newmark::residual(const DynamicState& s, const Eigen::VectorXd& x, double h, DynamicState& middle) const {
  const Eigen::VectorXd a = (x - h * s.velocity) / (beta_ * h * h) - (0.5 / beta_ - 1.0) * s.acceleration;
  const Eigen::VectorXd v = s.velocity + h * ((1.0 - gamma_) * s.acceleration + gamma_ * a);
  middle.time = s.time + (1.0 - alpha_f_) * h;
  middle.displacement = s.displacement + (1.0 - alpha_f_) * x;
  middle.velocity = (1.0 - alpha_f_) * v + alpha_f_ * s.velocity;
  middle.acceleration = (1.0 - alpha_m_) * a + alpha_m_ * s.acceleration;
  Eigen::VectorXd r = system_.force(middle.time, middle.displacement, middle.velocity);
  r -= system_.mass() * middle.acceleration;
  if (system_.damped()) r -= system_.damping() * middle.velocity;
  if (const auto& branches = system_.relaxations(); !branches.empty()) {
    const auto z = relax(branches, (1.0 - alpha_f_) * h, s.displacement, middle.displacement, s.relaxed);
    r -= system_.relaxing_stiffness() * overstretch(branches, middle.displacement, z);
  }
  zero_fixed(r, system_.fixed());
  return r;
}

void Newmark::factorize(const DynamicState& middle, double h) {
  SparseMatrix j = (1.0 - alpha_f_) * system_.stiffness(middle.time, middle.displacement, middle.velocity);
  j += (1.0 - alpha_m_) / (beta_ * h * h) * system_.mass();
  if (system_.damped()) j += (1.0 - alpha_f_) * gamma_ / (beta_ * h) * system_.damping();
  for (const Relaxation& branch : system_.relaxations()) {
    const double quick = branch.modulus * (1.0 - RelaxationStep(branch, (1.0 - alpha_f_) * h).to);
    j += (1.0 - alpha_f_) * quick * system_.relaxing_stiffness();
  }
  fix_dofs(j, system_.fixed(), j.diagonal().mean());
  solver_.factorize(j);
  updates_.clear();
  factored_step_ = h;
  ++factorisations_;
}

// The two-loop recursion of L-BFGS (Nocedal & Wright 2006, alg. 7.4) around the factored Jacobian.
Eigen::VectorXd Newmark::direction(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd q = residual;
  std::vector<double> weight(updates_.size());
  for (std::size_t i = updates_.size(); i-- > 0;) {
    weight[i] = updates_[i].inverse_curvature * updates_[i].step.dot(q);
    q -= weight[i] * updates_[i].change;
  }
  Eigen::VectorXd d = solver_.solve(q);
  for (std::size_t i = 0; i < updates_.size(); ++i) {
    d += (weight[i] - updates_[i].inverse_curvature * updates_[i].change.dot(d)) * updates_[i].step;
  }
  return d;
}

void Newmark::learn(Eigen::VectorXd step, Eigen::VectorXd change) {
  const double curvature = step.dot(change);
  if (!(curvature > kFlat * step.norm() * change.norm())) return;
  if (updates_.size() == kMostUpdates) updates_.pop_front();
  updates_.push_back({std::move(step), std::move(change), 1.0 / curvature});
}

bool Newmark::try_step(DynamicState& state, double h) {
  DynamicState middle;
  Eigen::VectorXd x = h * state.velocity + 0.5 * h * h * state.acceleration;
  double last = std::numeric_limits<double>::infinity();
  bool fresh = false;
  try {
    Eigen::VectorXd r = residual(state, x, h, middle);
    if (!solver_.ready() || std::abs(h - factored_step_) > kSameStep * factored_step_) {
      factorize(middle, h);
      fresh = true;
    }
    for (int k = 0; k < kMaxIterations; ++k) {
      ++iterations_;
      Eigen::VectorXd d = direction(r);
      const double size = d.cwiseAbs().maxCoeff();
      if (!std::isfinite(size)) return false;
      const bool slow = size > kSlow * last;
      if (slow && !fresh) {  // the factor is too old here: renew it and take this iteration again
        factorize(middle, h);
        fresh = true;
        last = std::numeric_limits<double>::infinity();
        continue;
      }
      if (slow && size > last) return false;
      fresh = false;
      last = size;
      if (size < tolerance_) {
        accept(state, x + d, h);
        return true;
      }
      // Shorten a correction that turns an element inside out.
      Eigen::VectorXd next;
      for (int cut = 0;; ++cut) {
        try {
          next = residual(state, x + d, h, middle);
          break;
        } catch (const NumericalError&) {
          if (cut == 6) return false;
          d *= 0.5;
        }
      }
      x += d;
      learn(std::move(d), r - next);
      r = std::move(next);
    }
  } catch (const NumericalError&) {
    return false;
  }
  return false;
}

void Newmark::accept(DynamicState& state, const Eigen::VectorXd& x, double h) {
  const Eigen::VectorXd a = (x - h * state.velocity) / (beta_ * h * h) - (0.5 / beta_ - 1.0) * state.acceleration;
  state.velocity += h * ((1.0 - gamma_) * state.acceleration + gamma_ * a);
  state.relaxed = relax(system_.relaxations(), h, state.displacement, state.displacement + x, state.relaxed);
  state.displacement += x;
  state.acceleration = a;
  state.time += h;
}

}  // namespace tissue_stiffness
