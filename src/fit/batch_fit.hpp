#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "filter/posterior_linearization_filter.hpp"
#include "fit/fit_problem.hpp"

namespace tissue_stiffness {

/// A batch fit holds the most probable parameters of a whole recording.
struct BatchFit {
  Eigen::VectorXd w;           ///< parameters in filter coordinates
  Eigen::MatrixXd covariance;  ///< of w, widened by the misfit
  double cost = 0.0;           ///< sum of squared errors over sigma at w, including the prior's
};

constexpr double no_rival = std::numeric_limits<double>::infinity();

/// Maximises the free run's posterior by Gauss-Newton from `start`. It linearises over `spread` (filter coordinates) at
/// first, later over what the data leave of each parameter with the others held. Steps that do not lower the cost are cut
/// and damped (Marquardt 1963, eq. 28). Steps that shrink slowly are extrapolated (Anderson 1965, J. ACM 12, p. 547).
/// `rival` is a cost to be beaten: the fit ends where its last fall is small compared with what is missing. Throws
/// NumericalError when the run at `start` diverges.
BatchFit fit_batch(const FitProblem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                   double rival = no_rival);

/// Fits as fit_batch does, with any prior: that of `filter`, which has seen no frame. The returned filter is anchored at
/// the most probable parameters.
PosteriorLinearizationFilter fit_filter(const FitProblem& problem, PosteriorLinearizationFilter filter,
                                        const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                                        double rival = no_rival);

/// One of several recordings that share parameters.
struct FitPart {
  FitProblem problem;
  std::vector<Eigen::Index> columns;  ///< place of each of the problem's parameters among those of all recordings
  double noise = 1.0;                 ///< factor on the variance of its sensors' noise
};

/// Fits several recordings at once: their sums of squares add up, and the prior of `filter` counts once.
PosteriorLinearizationFilter fit_filter(const std::vector<FitPart>& parts, PosteriorLinearizationFilter filter,
                                        const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                                        double rival = no_rival);

/// Returns the free runs' cost and rows at w, the parameters of all recordings.
FreeFit free_fit(const std::vector<FitPart>& parts, const Eigen::VectorXd& w);

}  // namespace tissue_stiffness
