#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fit/ensemble.hpp"

namespace tissue_stiffness {

/// A fit problem is a recording to fit, with all that the likelihoods below need.
struct FitProblem {
  const Model& model;
  const ForwardModel& forward;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators;
  const std::vector<Frame>& frames;
  RunStart start;
  /// It is called before every frame; what it throws ends the fit.
  std::function<void()> checkpoint = [] {};
};

/// Shows every frame in order of time with the free run at w: theta, and the body's displacement (3n) when the frame was
/// taken.
using ShowFrame = std::function<void(const Frame& frame, const Eigen::VectorXd& theta,
                                     const Eigen::Ref<const Eigen::VectorXd>& displacement)>;
void run_freely(const FitProblem& problem, const Eigen::VectorXd& w, const ShowFrame& show);

/// `cost` is the free run's sum of squared errors in sigmas, over `rows` rows. A row beyond the robust limit counts as one
/// at that limit.
struct FreeFit {
  double cost = 0.0, rows = 0.0;
};
FreeFit free_fit(const FitProblem& problem, const Eigen::VectorXd& w);
/// Returns cost and rows of one frame, with the body displaced as given (3n).
FreeFit fit_frame(const FitProblem& problem, const Frame& frame, const Eigen::VectorXd& theta,
                  const Eigen::Ref<const Eigen::VectorXd>& displacement);

}  // namespace tissue_stiffness
