#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/forward/modal_step.hpp"

namespace tissue_stiffness {

/// How a body's modes go from one frame to the next, under a constant force each:
///   q' = qq q + qv v + qf f,  v' = vq q + vv v + vf f.
struct ModalTransition {
  Eigen::ArrayXd qq, vq, qv, vv, qf, vf;
  /// Of the first `modes` of the `all` that the step is for, over `span` [s].
  ModalTransition(ModalStep step, double span, Eigen::Index modes, Eigen::Index all);
};

/// What one frame says of the modes' displacement: the residual's sum of squares is square - 2 seen^T q + q^T information
/// q.
struct FrameEvidence {
  Eigen::MatrixXd information;
  Eigen::VectorXd seen;
  double square = 0.0;
};

/// Standard deviations of the force on each mode.
struct ForcePrior {
  Eigen::VectorXd level;  ///< at first
  Eigen::VectorXd walk;   ///< of its step from frame to frame
};

/// Means given all frames.
struct SmoothedForce {
  std::vector<Eigen::VectorXd> displacement;  ///< of the modes at each frame
  std::vector<Eigen::VectorXd> force;         ///< on each mode, from each frame to the next
  double deviance = 0.0;                      ///< minus twice the log-likelihood, but for a constant
};

/// Modes from rest under forces that walk at random from frame to frame, seen through the residual: Kalman
/// filter, then the smoother of de Jong (1989, J. Am. Stat. Assoc. 84(408)), which inverts no covariance. One transition to
/// each frame.
SmoothedForce smooth_force(const std::vector<ModalTransition>& transitions, const std::vector<FrameEvidence>& evidence,
                           const ForcePrior& prior);

/// The prior at which the residual is likeliest (Schweppe 1965), first one for all modes, then each on its own; a mode
/// without need of a force has level 0. `scale`: of the forces.
ForcePrior likeliest_force_prior(const std::vector<ModalTransition>& transitions,
                                 const std::vector<FrameEvidence>& evidence, double scale);

/// Log of the number of priors that it tries for so many modes.
double log_of_tried_priors(Eigen::Index modes);

}  // namespace tissue_stiffness
