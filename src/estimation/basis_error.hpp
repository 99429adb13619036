#pragma once

#include <functional>
#include <memory>

#include "fit/fit_problem.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// A reduced basis tells by itself what it leaves out of the motion. A run in its earlier half is compared with the run in
/// all of it, times kBasisSafety. Load-dependent Ritz vectors take away a third of the error or more with each half. While
/// they do, the real error is not larger than this one; where they do better it is smaller by as much.
struct BasisError {
  double rms = 0.0;     ///< over the coordinates of the given nodes, in the worst frame [m]
  double sigmas = 0.0;  ///< rms in standard deviations of the most precise sensor's noise
};
constexpr double kBasisSafety = 2.0;
constexpr double kBasisShare = 0.1;  ///< of the noise: what a basis may leave out

/// Returns the error in the motion of `nodes`, over some thirty of the problem's frames, at filter coordinates w.
BasisError basis_error(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w,
                       const std::vector<int>& nodes);

/// How far a basis has grown.
struct BasisGrowth {
  std::shared_ptr<ReducedModel> larger;  ///< null: it has not grown
  int growths = 0;
  BasisError error;
  bool exhausted = false;  ///< more vectors do not help
};
/// Grows the basis by half at a time, until it leaves out a small part of the noise (kBasisShare), or growth helps no more.
/// An `exhausted` basis is only checked. The arguments are those of basis_error.
BasisGrowth grow_basis(const ReducedModel& reduced, bool exhausted, const FitProblem& problem, const Eigen::VectorXd& w,
                       const std::vector<int>& nodes);

/// Returns the standard deviation of the most precise sensor's noise [m].
double least_noise(const Model& model);
/// Returns whether a frame of the problem is one of those that are compared.
bool is_checked(std::size_t frame, const FitProblem& problem);

/// Returns what the reduced basis does to the parameters, about 1 sigma, in filter coordinates. The basis' earlier half is
/// fitted to a run in all of it, from w on, and the shift is multiplied by kBasisSafety. The fit is one Gauss-Newton step
/// over the frames that basis_error takes. `spread` is that of the sigma points; `prior_std` holds what the data do not
/// determine.
Eigen::VectorXd basis_shift(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w,
                            const Eigen::VectorXd& spread, const Eigen::VectorXd& prior_std);

/// Fits runs that `start` begins at any theta to `truth`, a run at w, in the same way. Returns by how much the parameters
/// move, without a safety factor.
Eigen::VectorXd fitted_shift(const FitProblem& problem, Trajectory& truth,
                             const std::function<std::unique_ptr<Trajectory>(const Eigen::VectorXd&)>& start,
                             const Eigen::VectorXd& w, const Eigen::VectorXd& spread, const Eigen::VectorXd& prior_std);

}  // namespace tissue_stiffness
