#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/fit_problem.hpp"

namespace tissue_stiffness {

/// Parameters that changed while the body moved.
struct Change {
  RunStart from;          ///< when, and how the body moved then
  Eigen::VectorXd w;      ///< after it, filter coordinates
  Eigen::VectorXd doubt;  ///< of them, about 1 sigma, because of what is not known of the instant and of what was before
  std::size_t first = 0;  ///< frame after it
};

/// What is known before a change.
struct ChangeQuestion {
  Eigen::VectorXd w;           ///< parameters before it, filter coordinates
  Eigen::MatrixXd covariance;  ///< their posterior then
  double misfit = 1.0;         ///< mean square error over sigma before it
  std::optional<double> near;  ///< about when [s]; empty: somewhen in the last frames
};

/// How far the parameters may have drifted over `span` [s], variance of each; of a second at least.
Eigen::VectorXd drifted(const Model& model, double span);

/// The change that explains the last frames: looks back from the newest over instants and, at each, along every
/// drifting coordinate, for where the sum of squared errors over sigma and of the change over its own standard deviation is
/// least; then closer around the best. Empty where that is not clearly less than without a change (by 20 and by four fifths
/// of what the misfit exceeds the one before), as it is for physics that the model lacks. Throws NumericalError as runs do.
std::optional<Change> find_change(const FitProblem& problem, const ChangeQuestion& question);

}  // namespace tissue_stiffness
