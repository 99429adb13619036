#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit/fit_problem.hpp"
#include "tissue_stiffness/types/free_frame.hpp"

namespace tissue_stiffness {

/// From `time` on the parameters are theta.
struct ParameterChange {
  double time = 0.0;  ///< [s]
  Eigen::VectorXd theta;
};

/// Runs the model at `theta`, and after each of `changes` at its parameters. Returns one misfit for every frame. `visit`,
/// where there is one, sees each frame. Throws NumericalError when the run diverges.
std::vector<Misfit> free_run(const FitProblem& problem, Eigen::VectorXd theta, const FreeFrameVisitor& visit,
                             const std::vector<ParameterChange>& changes = {});

}  // namespace tissue_stiffness
