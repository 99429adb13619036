#pragma once

#include "diagnosis/model_comparison.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns the probability that a model is valid on each part of the surface in each third of the recording. There the
/// model leaves x along the lowest modes, in noise variances over nu independent degrees of freedom. This is compared with
/// what an excess 1 + g of the variance would leave, with log g uniform over three decades. Both are equally probable
/// beforehand:
///   log BF = log mean_g (1 + g)^(-nu/2) exp(x g / (1 + g) / 2).
/// `left` is what the model leaves, see Assessment. A part or third that no row sees has probability 1/2.
BeliefMap belief_map(const FittedModel& model, const Eigen::VectorXd& left, const ModelComparison& comparison);

/// Returns the log of that Bayes factor.
double log_evidence_of_excess(double x, double degrees_of_freedom);

}  // namespace tissue_stiffness
