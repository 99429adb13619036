#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/corrected_runs.hpp"

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
/// The motion's own: the sum of the square distances from a body that stays at rest, weighted as in the fit.
double motion_cost(const FitProblem& problem, const Eigen::VectorXd& w);
/// The same of one frame, the body displaced as given (3n).
FreeFit fit_frame(const FitProblem& problem, const Frame& frame, const Eigen::VectorXd& theta,
                  const Eigen::Ref<const Eigen::VectorXd>& displacement);

/// Where corrected runs explain the recording best, and by how much they are to be corrected.
struct Correction {
  Eigen::VectorXd w;
  Eigen::VectorXd step;  ///< resolution of the search along each coordinate; 0 where w is as it was
  double force = 0.0;    ///< see StateCorrection
};
/// The place and the missing force with the highest likelihood, for a linear model from rest that fits badly: looks around
/// the prior with much and with little correction, and at `w`. Empty when the free run at `w` is likelier than all of them.
std::optional<Correction> choose_correction(const FitProblem& problem, const Eigen::VectorXd& w);

}  // namespace tissue_stiffness
