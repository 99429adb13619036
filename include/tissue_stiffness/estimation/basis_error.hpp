#pragma once

#include "tissue_stiffness/estimation/fit_problem.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"

namespace tissue_stiffness {

/// What a reduced basis leaves out of the motion, from the basis itself: the run in its earlier half against the run
/// in all of it, times kBasisDoubt. While each half of the vectors takes away a third of the error or more, as
/// load-dependent Ritz vectors do, the real error is not larger; where they do better it is smaller by as much.
struct BasisError {
  double rms = 0.0;     ///< over the coordinates of some nodes, of the worst frame [m]
  double sigmas = 0.0;  ///< the same in standard deviations of the most precise sensor's noise
};
constexpr double kBasisDoubt = 2.0;
constexpr double kBasisShare = 0.1;  ///< of the noise: what a basis may leave out

/// Of the motion of `nodes`, over some thirty of the problem's frames, at filter coordinates w.
BasisError basis_error(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w,
                       const std::vector<int>& nodes);

/// What the reduced basis does to the parameters, about 1 sigma: the fit of its earlier half to a run in all of it, from w
/// on, in filter coordinates, times kBasisDoubt. One Gauss-Newton step over the same frames; `spread`: of the sigma points;
/// `prior_std` holds what the data do not determine.
Eigen::VectorXd basis_shift(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w,
                            const Eigen::VectorXd& spread, const Eigen::VectorXd& prior_std);

}  // namespace tissue_stiffness
