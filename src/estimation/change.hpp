#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fit/fit_problem.hpp"

namespace tissue_stiffness {

/// A change says when the parameters changed while the body moved, and to what.
struct Change {
  RunStart from;                ///< instant of the change, and the body's motion then
  Eigen::VectorXd w;            ///< parameters after it, filter coordinates
  Eigen::VectorXd discrepancy;  ///< of w, about 1 sigma: the instant and the parameters before it are uncertain
  std::size_t first = 0;        ///< first frame after it
};

/// A question holds what is known before a change.
struct ChangeQuestion {
  Eigen::VectorXd w;           ///< parameters before it, filter coordinates
  Eigen::MatrixXd covariance;  ///< their posterior at that time
  double misfit = 1.0;         ///< mean square error over sigma before it
  std::optional<double> near;  ///< approximate instant [s]; empty: any time in the last frames
};

/// Returns the variance by which each parameter may have drifted over `span` [s], or over a second if that is longer.
Eigen::VectorXd drifted(const Model& model, double span);

/// Searches for the change that explains the last frames. It goes back from the newest over several instants and scans
/// every drifting coordinate at each, then searches closer around the best. The cost is the sum of squared errors over
/// sigma, plus that of the change over its own standard deviation. Returns nothing where the lowest cost is not clearly
/// less than without a change, as for physics that the model lacks. It has to fall by 20, and by four fifths of the
/// misfit's excess over the one before. Throws NumericalError as runs do.
std::optional<Change> find_change(const FitProblem& problem, const ChangeQuestion& question);

}  // namespace tissue_stiffness
