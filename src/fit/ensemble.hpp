#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "forward/forward_model.hpp"
#include "observation/predict_frame.hpp"

namespace tissue_stiffness {

/// An ensemble holds the sigma points' free runs, which advance side by side.
class Ensemble {
 public:
  Ensemble(const Model& model, const ForwardModel& forward,
           const std::vector<std::unique_ptr<ObservationOperator>>& operators)
      : model_(model), forward_(forward), operators_(operators) {}

  /// Starts a fresh trajectory for each column of `sigma_points` (filter coordinates).
  void restart(const Eigen::MatrixXd& sigma_points, const RunStart& start);

  /// Advances all trajectories to `time`, in parallel. Throws NumericalError when one diverges.
  void advance(double time);

  /// The predictions of a frame are the first sigma point's in full, and the predicted rows of all of them as columns.
  struct Predicted {
    Prediction central;
    Eigen::MatrixXd rows;  ///< rows x sigma points
  };
  Predicted predict(const Frame& frame) const;

  /// Returns the displacements, one column a sigma point, 3n x sigma points [m]. They are filled in at the nodes of the
  /// forward model's output.
  const Eigen::MatrixXd& displacements() const { return displacements_; }
  /// Writes the displacements' weighted sum at every node, 3n.
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const { runs_->combine(weights, sum); }
  /// Returns one sigma point's trajectory, for linear models only, whose runs are separate.
  Trajectory& trajectory(std::size_t i) { return dynamic_cast<SeparateTrajectories&>(*runs_)[i]; }

 private:
  const Model& model_;
  const ForwardModel& forward_;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators_;
  std::vector<Eigen::VectorXd> theta_;  ///< parameters of each sigma point
  std::unique_ptr<Trajectories> runs_;
  Eigen::MatrixXd displacements_;
};

}  // namespace tissue_stiffness
