#pragma once

#include <Eigen/Core>
#include <limits>

#include "tissue_stiffness/estimation/fit_problem.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"

namespace tissue_stiffness {

/// The most probable parameters of a whole recording.
struct BatchFit {
  Eigen::VectorXd w;           ///< filter coordinates
  Eigen::MatrixXd covariance;  ///< of w, as wide as the misfit asks
  double cost = 0.0;           ///< sum of squared errors over sigma at w, the prior's included
};

constexpr double no_rival = std::numeric_limits<double>::infinity();

/// Gauss-Newton on the free run's posterior from `start`, linearised over `spread` (filter coordinates) at first and later
/// over what the data leave of each parameter beside the others. Steps that do not lower the cost are cut and damped
/// (Marquardt 1963, eq. 28), steps that shrink slowly extrapolated (Anderson 1965, J. ACM 12, p. 547). Throws
/// NumericalError when the run at `start` diverges. `rival`: a cost that is to be beaten; ends where the last fall is small
/// beside what is missing.
BatchFit fit_batch(const FitProblem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                   double rival = no_rival);

/// The same with any prior: that of `filter`, which has seen no frame. Ends anchored at the most probable parameters.
AnchoredFilter fit_filter(const FitProblem& problem, AnchoredFilter filter, const Eigen::VectorXd& start,
                          const Eigen::VectorXd& spread, double rival = no_rival);

}  // namespace tissue_stiffness
