#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <vector>

#include "forward/model.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// d predicted rows / d u, as rows x 3n. A row without a counterpart is empty.
using RowTangent = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// An observation operator predicts what a sensor should see of the body at nodal displacement u (eq. 2 of Yang & Lin
/// 2016).
class ObservationOperator {
 public:
  virtual ~ObservationOperator() = default;
  /// Throws InputError for an observation that does not fit the mesh (a vertex out of range, ...).
  virtual void check(const Observation& observation) const = 0;
  /// The rows depend on the observation alone, so predictions for different u line up. A row is NaN where the model has no
  /// counterpart.
  virtual Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const = 0;
  /// Returns the derivative of predict() at u. Sensors whose rows depend on few nodes have none: differences are as fast.
  virtual std::optional<RowTangent> tangent(const Observation&, const Eigen::Ref<const Eigen::VectorXd>&) const {
    return {};
  }
  /// Returns d predicted rows / d (offset [m], rotation [rad]) of the body against the sensor, rows x 6, about the mean
  /// of the mesh's nodes. It is for sensors that only see the motion since rest; to the others the body seems moved.
  virtual std::optional<Eigen::MatrixXd> pose_tangent(const Observation&, const Eigen::Ref<const Eigen::VectorXd>&) const {
    return {};
  }
  /// Returns the mesh nodes that a prediction of this observation depends on.
  virtual std::vector<int> nodes(const Observation& observation) const = 0;
  /// Returns what the model shows in the sensor's image, as separate segments (u0, v0, u1, v1) [pixel]: its outline, or the
  /// displacement of each feature since rest. It is empty for sensors without images.
  virtual Eigen::Matrix4Xd outline(const Observation&, const Eigen::VectorXd&) const { return {}; }
};

/// Returns one operator for each entry of the model file's `observations`, in that order. Throws InputError for an entry
/// that does not fit the model.
std::vector<std::unique_ptr<ObservationOperator>> make_observation_operators(const Model& model);

std::unique_ptr<ObservationOperator> make_vertex_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_marker_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_point_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_contour_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_track_operator(const Model& model, const ObservationSettings& settings);
/// Its predictions need a run's whole output, see Model::output_size.
std::unique_ptr<ObservationOperator> make_reaction_operator(const Model& model, const ObservationSettings& settings);

/// Returns the nodes that predictions of these frames depend on, in ascending order.
std::vector<int> observed_nodes(const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                                const std::vector<Frame>& frames);

/// Joins the predictions of a frame's observations.
Prediction concatenate_predictions(std::vector<Prediction> parts);

}  // namespace tissue_stiffness
