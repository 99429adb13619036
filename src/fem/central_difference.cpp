#include "fem/central_difference.hpp"

#include <cmath>

#include "fem/products.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSafety = 0.6;  // of the stable step at rest: elements get thinner, contact stiffens them
constexpr int kPowerIterations = 60;

}  // namespace

CentralDifference::CentralDifference(const DynamicSystem& system, double start) : system_(system) {
  const SparseMatrix& mass = system.mass();
  const Eigen::Index n = mass.rows();
  const Eigen::VectorXd diagonal = mass.diagonal();
  const Eigen::VectorXd lumped = diagonal * (mass * Eigen::VectorXd::Ones(n)).sum() / diagonal.sum();
  inverse_mass_ = lumped.cwiseInverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (system.fixed()[static_cast<std::size_t>(i)] != 0) inverse_mass_[i] = 0.0;
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  SparseMatrix k = system.stiffness(start, zero, zero);
  for (const Relaxation& branch : system.relaxations()) k += branch.modulus * system.relaxing_stiffness();
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  for (Eigen::Index i = 1; i < n; i += 2) x[i] = -x[i];  // rough: near the highest mode from the start
  double square = 0.0;
  for (int i = 0; i < kPowerIterations; ++i) {
    x = inverse_mass_.cwiseProduct(k * x);
    square = x.norm();
    x /= square;
  }
  const double omega = std::sqrt(square);
  double damping_ratio = 0.0;  // of the highest mode
  if (system.damped()) damping_ratio = 0.5 * x.dot(inverse_mass_.cwiseProduct(system.damping() * x)) / omega;
  if (system.has_velocity_tangent())
    damping_ratio += 0.5 * x.dot(inverse_mass_.cwiseProduct(system.friction(start, zero, zero) * x)) / omega;
  largest_step_ = kSafety * 2.0 / omega * (std::sqrt(1.0 + damping_ratio * damping_ratio) - damping_ratio);
}

void CentralDifference::find_acceleration(DynamicState& state) {
  Eigen::VectorXd& f = state.acceleration;
  f.setZero(state.displacement.size());
  system_.add_force(state.time, state.displacement, state.velocity, f);
  if (system_.damped()) subtract_product(system_.damping(), state.velocity, f);
  if (const auto& branches = system_.relaxations(); !branches.empty()) {
    overstretch(branches, strain_, state.relaxed, stretch_);
    system_.subtract_relaxing_force(state.displacement, stretch_, f);
  }
  f.array() *= inverse_mass_.array();
}

void CentralDifference::initialise(DynamicState& state) {
  start_relaxed(system_, state);
  if (!system_.relaxations().empty()) system_.find_relaxing_strain(state.displacement, strain_);
  find_acceleration(state);
}

void CentralDifference::advance(DynamicState& state, double span) {
  const int steps = static_cast<int>(std::ceil(span / largest_step_));
  const double h = span / steps, start = state.time;
  for (int k = 1; k <= steps; ++k) {
    state.velocity += 0.5 * h * state.acceleration;
    next_ = state.displacement + h * state.velocity;
    if (const auto& branches = system_.relaxations(); !branches.empty()) {
      system_.find_relaxing_strain(next_, next_strain_);
      relax(branches, h, strain_, next_strain_, state.relaxed);
      strain_.swap(next_strain_);
    }
    state.displacement.swap(next_);
    state.time = start + h * k;
    find_acceleration(state);
    state.velocity += 0.5 * h * state.acceleration;
  }
  if (!state.displacement.allFinite())
    throw NumericalError("explicit step diverges at " + std::to_string(state.time) + " s");
}

}  // namespace tissue_stiffness
