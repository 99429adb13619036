#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/force_smoother.hpp"
#include "diagnosis/model_comparison.hpp"
#include "fit/recording_fit.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns the equivalent missing force of a model with parameters w. Each of the lowest modes obeys
///   q'' + d q' + omega^2 q = f,
/// where f is a random walk in steps at the frames. It is smoothed from the free run's residual, which is taken as linear
/// in q (force_smoother.hpp). The force per mass at a place is the modes' shapes there times f [N/kg]. It is empty where no
/// force is likelier than noise. What is not linear in the model acts as it does in the free run.
MissingForce missing_force(const RecordingFit& recording_fit, const Eigen::VectorXd& w);

/// A random force is an unknown force on a model's lowest modes that walks at random.
struct RandomForce {
  RandomForce() = default;
  explicit RandomForce(const FittedModel& model);

  std::vector<ModalTransition> transitions;  ///< to each frame
  Eigen::MatrixXd along;                     ///< rows / displacement of each mode [sigma/(m kg^1/2)]
  double scale = 0.0;                        ///< rms of the forces that move the modes
};
/// Returns the log evidence that what a model leaves along the lowest modes is the work of such a force, beyond that of
/// noise and the mesh's error, by the size of that error. It is the force's marginal likelihood (Schweppe 1965) at its best
/// prior, less the log of the number of priors that were tried. `alone` assesses the model without the force.
Eigen::VectorXd log_evidence_gained(const RandomForce& force, const Assessment& alone, const ModelComparison& comparison);

}  // namespace tissue_stiffness
