#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/forward/forward_model.hpp"
#include "tissue_stiffness/forward/observation_operator.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// The sigma points' free runs, side by side.
class Ensemble {
 public:
  Ensemble(const Model& model, const ForwardModel& forward,
           const std::vector<std::unique_ptr<ObservationOperator>>& operators)
      : model_(model), forward_(forward), operators_(operators) {}

  /// A fresh trajectory for each column of `sigma_points` (filter coordinates).
  void restart(const Eigen::MatrixXd& sigma_points, const RunStart& start);

  /// All trajectories to `time`, in parallel. Throws NumericalError when one diverges.
  void advance(double time);

  /// Predictions of a frame: the first sigma point's in full, and everyone's predicted rows as columns.
  struct Predicted {
    Prediction central;
    Eigen::MatrixXd rows;  ///< rows x sigma points
  };
  Predicted predict(const Frame& frame) const;

  /// Displacements, one column a sigma point, 3n x sigma points [m]; of the nodes in the forward model's focus.
  const Eigen::MatrixXd& displacements() const { return displacements_; }
  /// Their weighted sum, 3n, every node.
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const { runs_->combine(weights, sum); }
  /// Linear models only, whose runs are separate.
  Trajectory& trajectory(std::size_t i) { return dynamic_cast<SeparateTrajectories&>(*runs_)[i]; }

 private:
  const Model& model_;
  const ForwardModel& forward_;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators_;
  std::vector<Eigen::VectorXd> theta_;  ///< of each sigma point
  std::unique_ptr<Trajectories> runs_;
  Eigen::MatrixXd displacements_;
};

/// A frame's observations against one displacement (3n), with what the sensors at theta make of it.
Prediction predict_frame(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                         const Frame& frame, const Eigen::VectorXd& theta,
                         const Eigen::Ref<const Eigen::VectorXd>& displacement);

/// The frame holds displacements of named nodes or markers only, which no parameter of a sensor changes.
bool sees_named_nodes(const Model& model, const Frame& frame);

/// d predicted rows / d amplitude of each of `shapes` (3n x count) about a displacement, rows x count; `there`: the
/// prediction at the displacement itself.
Eigen::MatrixXd predict_along(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                              const Frame& frame, const Eigen::VectorXd& theta,
                              const Eigen::Ref<const Eigen::VectorXd>& displacement, const Prediction& there,
                              const Eigen::MatrixXd& shapes);

}  // namespace tissue_stiffness
