#pragma once

#include <memory>
#include <vector>

#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/estimation/state_correction.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"

namespace tissue_stiffness {

/// An ensemble of reduced runs that are corrected towards every frame they have seen. Linear models only.
class CorrectedRuns {
 public:
  /// force: see StateCorrection.
  CorrectedRuns(const Model& model, const ForwardModel& forward,
                const std::vector<std::unique_ptr<ObservationOperator>>& operators, double force)
      : model_(model), operators_(operators), ensemble_(model, forward, operators), correction_(force) {}

  void restart(const Eigen::MatrixXd& sigma_points, double start);
  /// Advances to the frame, gives the filter its whitened innovations, and corrects the runs.
  AnchoredFilter::Innovation absorb(const Frame& frame, AnchoredFilter& filter);
  /// Minus twice the log-likelihood of the frames at one point of the parameters, but for a constant.
  double deviance(const std::vector<Frame>& frames, const Eigen::VectorXd& w, double start);

 private:
  Eigen::MatrixXd sensitivity(const Frame& frame, const Prediction& central) const;
  void advance(double time);
  void correct(const Eigen::MatrixXd& step);
  ReducedTrajectory& run(std::size_t i);

  const Model& model_;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators_;
  Ensemble ensemble_;
  StateCorrection correction_;
  double time_ = 0.0;
  Eigen::VectorXd theta_;              ///< of the anchor
  Eigen::MatrixXd shapes_, in_basis_;  ///< of the anchor's modes
};

/// Root mean square over the frames of the forces that move the lowest modes (elastic and inertial), the scale on which to
/// look for a missing one.
double modal_force_scale(const Model& model, const ForwardModel& forward, const std::vector<Frame>& frames,
                         const Eigen::VectorXd& w, double start);

}  // namespace tissue_stiffness
