#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "tissue_stiffness/estimation/ensemble.hpp"

namespace tissue_stiffness {

/// A recording to fit: what every likelihood below needs.
struct FitProblem {
  const Model& model;
  const ForwardModel& forward;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators;
  const std::vector<Frame>& frames;
  RunStart start;
  /// Called before every frame; what it throws ends the fit.
  std::function<void()> checkpoint = [] {};
};

/// Shows every frame with the free run at w, ascending: theta, and the body's displacement (3n) when the frame was taken.
using ShowFrame = std::function<void(const Frame& frame, const Eigen::VectorXd& theta,
                                     const Eigen::Ref<const Eigen::VectorXd>& displacement)>;
void run_freely(const FitProblem& problem, const Eigen::VectorXd& w, const ShowFrame& show);

/// Sum over rows of the square error of the free run, in sigmas, each row's growing slower beyond the robust limit.
struct FreeFit {
  double cost = 0.0, rows = 0.0;
};
FreeFit free_fit(const FitProblem& problem, const Eigen::VectorXd& w);
/// The same of one frame, the body displaced as given (3n).
FreeFit fit_frame(const FitProblem& problem, const Frame& frame, const Eigen::VectorXd& theta,
                  const Eigen::Ref<const Eigen::VectorXd>& displacement);

}  // namespace tissue_stiffness
