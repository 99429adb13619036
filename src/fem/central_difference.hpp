#pragma once

#include <Eigen/Core>

#include "fem/generalized_alpha.hpp"

namespace tissue_stiffness {

/// Explicit central differences with a lumped mass (Newmark with beta = 0, gamma = 1/2). They are for impacts, where the
/// motion itself needs steps near the stable one. The mass is lumped in proportion to the consistent diagonal (Hinton, Rock
/// & Zienkiewicz 1976).
class CentralDifference {
 public:
  /// Computes the stable step from the largest eigenvalue of M^-1 K at rest.
  explicit CentralDifference(const DynamicSystem& system, double start);

  /// Returns the largest step that is taken [s].
  double largest_step() const { return largest_step_; }
  void initialise(DynamicState& state);
  /// Advances by `span` [s] in equal steps. Throws NumericalError when the motion diverges.
  void advance(DynamicState& state, double span);

 private:
  void find_acceleration(DynamicState& state);

  const DynamicSystem& system_;
  Eigen::VectorXd inverse_mass_;  ///< 0 for fixed degrees of freedom
  double largest_step_ = 0.0;
  Eigen::VectorXd next_;                            ///< displacement after a step
  Eigen::VectorXd strain_, next_strain_, stretch_;  ///< of the relaxing branches; sum modulus (strain - z)
};

}  // namespace tissue_stiffness
