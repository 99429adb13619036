#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "tissue_stiffness/fit/fit_problem.hpp"
#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// A free frame is one frame of a free run, compared with its recording.
struct FreeFrame {
  const Frame& frame;
  const Prediction& prediction;  ///< rows of the frame's observations, one after the other
  const Misfit& misfit;
  const Eigen::VectorXd& displacement;  ///< 3n [m]
  /// It returns the model's outline in a contour observation's image, as ObservationOperator::outline does.
  std::function<Eigen::Matrix4Xd(const Observation&)> outline;
};
using FreeFrameVisitor = std::function<void(const FreeFrame&)>;

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
