#pragma once

#include <Eigen/Core>

#include "forward/full_model.hpp"
#include "forward/hyper_reduced_trajectory.hpp"

namespace tissue_stiffness {

/// What a hyper-reduced run lacks in the balance of the model in full: r = f(t, u, v) - C v - M a at its last step, with
/// u, v and a of all nodes. Its size sqrt(sum of r_i^2 / K_ii) [J^(1/2)], with the diagonal of the stiffness at rest, is no
/// displacement. It tells whether the run has left what it was compared for.
class FullResidual {
 public:
  FullResidual(const Model& model, const Eigen::VectorXd& theta);
  /// Returns the size at a run with this theta. Throws NumericalError where an element is turned inside out.
  double of(const HyperReducedTrajectory& run) const;

 private:
  ModelSystem system_;
  Eigen::VectorXd compliance_;  ///< 1 / K_ii, and 0 at nodes that are held
};

}  // namespace tissue_stiffness
