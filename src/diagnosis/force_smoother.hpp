#pragma once

#include <Eigen/Core>
#include <vector>

#include "forward/modal_step.hpp"

namespace tissue_stiffness {

constexpr int most_force_modes = 12;  ///< on which a random force may act

/// A transition takes a body's modes from one frame to the next, under a constant force each:
///   q' = qq q + qv v + qf f,  v' = vq q + vv v + vf f.
struct ModalTransition {
  Eigen::ArrayXd qq, vq, qv, vv, qf, vf;
  /// Takes the first `modes` of the `all` modes that the step is for, over `span` [s].
  ModalTransition(ModalStep step, double span, Eigen::Index modes, Eigen::Index all);
};

/// One frame's evidence on the modes' displacement q: the residual's sum of squares is
///   square - 2 seen^T q + q^T information q.
struct FrameEvidence {
  Eigen::MatrixXd information;
  Eigen::VectorXd seen;
  double square = 0.0;
};

/// The prior holds standard deviations of the force on each mode.
struct ForcePrior {
  Eigen::VectorXd level;  ///< at the start
  Eigen::VectorXd walk;   ///< of its step from frame to frame
};

/// These are means given all frames.
struct SmoothedForce {
  std::vector<Eigen::VectorXd> displacement;  ///< of the modes at each frame
  std::vector<Eigen::VectorXd> force;         ///< on each mode, from each frame to the next
  double deviance = 0.0;                      ///< minus twice the log-likelihood, but for a constant
};

/// Estimates modes that start from rest under forces that walk at random from frame to frame, and are seen through the
/// residual. A Kalman filter is followed by the smoother of de Jong (1989, J. Am. Stat. Assoc. 84(408)), which inverts no
/// covariance. There is one transition to each frame, and at most `most_force_modes` modes.
SmoothedForce smooth_force(const std::vector<ModalTransition>& transitions, const std::vector<FrameEvidence>& evidence,
                           const ForcePrior& prior);

/// Returns the prior at which the residual is likeliest (Schweppe 1965), first one for all modes, then each on its own. A
/// mode that needs no force has level 0. `scale` is the size of the forces.
ForcePrior likeliest_force_prior(const std::vector<ModalTransition>& transitions,
                                 const std::vector<FrameEvidence>& evidence, double scale);

/// Returns the log of the number of priors that it tries for so many modes.
double log_of_tried_priors(Eigen::Index modes);

}  // namespace tissue_stiffness
