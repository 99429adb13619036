#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/diagnosis/force_smoother.hpp"
#include "tissue_stiffness/diagnosis/model_comparison.hpp"
#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// The equivalent missing force of a model with parameters w. Each of the lowest modes obeys
///   q'' + d q' + omega^2 q = f,
/// f a random walk in steps at the frames, smoothed from the free run's residual, which is taken as linear in q
/// (force_smoother.hpp); the force per mass at a place is the modes' shapes there times f [N/kg]. Empty where no force is
/// likelier than noise. What is not linear in the model acts as it does in the free run.
MissingForce missing_force(const Study& study, const Eigen::VectorXd& w);

/// A force on a model's lowest modes that walks at random, whatever it is.
struct RandomForce {
  RandomForce() = default;
  explicit RandomForce(const Fitted& model);

  std::vector<ModalTransition> transitions;  ///< to each frame
  Eigen::MatrixXd along;                     ///< rows / displacement of each mode [sigma/(m kg^1/2)]
  std::vector<Eigen::Index> offsets;         ///< see Study::Rows
  double scale = 0.0;                        ///< rms of the forces that move the modes
};
/// Log evidence of what a model leaves being the work of such a force, beyond that of its being noise and the mesh's error:
/// the force's marginal likelihood (Schweppe 1965) at its best prior, less the log of the number of priors that were tried.
/// `alone`: the model without the force.
double log_evidence_gained(const RandomForce& force, const Assessment& alone, const ModelComparison& comparison);

}  // namespace tissue_stiffness
