#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/fem/newmark.hpp"

namespace tissue_stiffness {

/// Explicit central differences with a lumped mass (Newmark with beta = 0, gamma = 1/2): for impacts, where the motion
/// itself asks for steps near the stable one. The mass is lumped in proportion to the consistent diagonal (Hinton, Rock &
/// Zienkiewicz 1976).
class CentralDifference {
 public:
  /// Finds the stable step from the largest eigenvalue of M^-1 K at rest.
  explicit CentralDifference(const DynamicSystem& system, double start);

  /// Step that is taken at most [s].
  double largest_step() const { return largest_step_; }
  void initialise(DynamicState& state);
  /// Advances by `span` [s] in equal steps. Throws NumericalError when the motion blows up.
  void advance(DynamicState& state, double span);

 private:
  void find_acceleration(DynamicState& state);

  const DynamicSystem& system_;
  Eigen::VectorXd inverse_mass_;  ///< 0 for fixed degrees of freedom
  double largest_step_ = 0.0;
  Eigen::VectorXd next_, stretch_;  ///< displacement after a step; what relaxing branches pull at
};

}  // namespace tissue_stiffness
