#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "fit/fit_problem.hpp"

namespace tissue_stiffness {

/// Returns whether runs of the model may be hyper-reduced, and are not linear.
bool may_be_hyper_reduced(const Model& model);

/// The forward model to go on with, and what it leaves out.
struct HyperReduction {
  std::shared_ptr<ForwardModel> forward;
  std::optional<double> error;  ///< of the surface's motion in the worst frame, times kBasisSafety [m]; empty: runs in full
  Eigen::VectorXd shift;        ///< estimate less that of runs in full, filter coordinates; empty: runs in full
  double residual = 0.0;        ///< largest in these frames (FullResidual)
  double accepted = 0.0;        ///< for the next question
};

/// Around what a hyper-reduced model is made or checked, in filter coordinates.
struct ReductionQuestion {
  Eigen::VectorXd w;             ///< the estimate
  Eigen::MatrixXd sigma_points;  ///< where the filter runs the model
  Eigen::VectorXd spread, prior_std;
  double accepted = 0.0;  ///< error over the noise that is no reason for another training, because the last did not help
};

/// Runs the model in full over the problem's frames. If `forward` (in full, or hyper-reduced) has no reduced form yet, one
/// is trained with full runs at the estimate and at the sigma points. It is then compared with the full run at the
/// estimate. While it leaves out more than kHyperShare of the noise, it is trained again with that run's motions, and with
/// more vectors and points, unless that did not help before. Where it leaves out more than the noise in the end, or runs in
/// full take explicit steps, which have another mass, the runs go on in full. The shift is that of the fit of the reduced
/// model to the full run. Throws NumericalError as runs in full do.
constexpr double kHyperShare = 0.3;
HyperReduction hyper_reduce(const FitProblem& problem, const std::shared_ptr<ForwardModel>& forward,
                            const ReductionQuestion& question);

/// Returns the model in full that a hyper-reduced one stands for, and any other model as it is.
std::shared_ptr<ForwardModel> in_full(const std::shared_ptr<ForwardModel>& forward);

}  // namespace tissue_stiffness
