#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "tissue_stiffness/forward/forward_model.hpp"
#include "tissue_stiffness/forward/observation_operator.hpp"
#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// One frame of a free run beside its recording.
struct FreeFrame {
  const Frame& frame;
  const Prediction& prediction;  ///< rows of the frame's observations, one after the other
  const Misfit& misfit;
  const Eigen::VectorXd& displacement;  ///< 3n [m]
  /// Of the model in a contour observation's image, as ObservationOperator::outline gives it.
  std::function<Eigen::Matrix4Xd(const Observation&)> outline;
};
using FreeFrameVisitor = std::function<void(const FreeFrame&)>;

/// From this time on the parameters are others.
struct Turn {
  double time = 0.0;  ///< [s]
  Eigen::VectorXd theta;
};

/// A model with what it needs to be run beside a recording.
struct FreeRunProblem {
  const Model& model;
  const ForwardModel& forward;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators;
  const std::vector<Frame>& frames;
  RunStart start;
};

/// Runs the model at `theta`, and after each of `turns` at its parameters, and compares it with every frame: one misfit a
/// frame. `visit`, where there is one, sees each. Throws NumericalError when the run diverges.
std::vector<Misfit> free_run(const FreeRunProblem& problem, Eigen::VectorXd theta, const FreeFrameVisitor& visit,
                             const std::vector<Turn>& turns = {});

/// The frame's prediction for a body that has not moved.
Prediction predict_at_rest(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                           const Frame& frame);

}  // namespace tissue_stiffness
