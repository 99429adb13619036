#include "tissue_stiffness/fem/newmark.hpp"

#include <cmath>
#include <limits>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMaxIterations = 40;
constexpr int kMaxHalvings = 10;
constexpr double kSlow = 0.4;       // a contraction worse than this asks for a fresh factor
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

void Newmark::initialise(DynamicState& state) const {
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
  zero_fixed(r, system_.fixed());
  return r;
}

void Newmark::factorize(const DynamicState& middle, double h) {
  SparseMatrix j = (1.0 - alpha_f_) * system_.stiffness(middle.time, middle.displacement, middle.velocity);
  j += (1.0 - alpha_m_) / (beta_ * h * h) * system_.mass();
  if (system_.damped()) j += (1.0 - alpha_f_) * gamma_ / (beta_ * h) * system_.damping();
  fix_dofs(j, system_.fixed(), j.diagonal().mean());
  solver_.factorize(j);
  factored_step_ = h;
  ++factorisations_;
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
      const Eigen::VectorXd d = solver_.solve(r);
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
      // Shorten a correction that turns an element inside out.
      double length = 1.0;
      for (int cut = 0;; ++cut) {
        try {
          r = residual(state, x + length * d, h, middle);
          break;
        } catch (const NumericalError&) {
          if (cut == 6) return false;
          length *= 0.5;
        }
      }
      x += length * d;
      if (size < tolerance_ && length == 1.0) {
        const Eigen::VectorXd a = (x - h * state.velocity) / (beta_ * h * h) - (0.5 / beta_ - 1.0) * state.acceleration;
        state.velocity += h * ((1.0 - gamma_) * state.acceleration + gamma_ * a);
        state.displacement += x;
        state.acceleration = a;
        state.time += h;
        return true;
      }
    }
  } catch (const NumericalError&) {
    return false;
  }
  return false;
}

}  // namespace tissue_stiffness
