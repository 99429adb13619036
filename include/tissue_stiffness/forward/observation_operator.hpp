#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/forward/model.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// Eq. 2 of Yang & Lin (2016): what a sensor should see of the body at nodal displacement u.
class ObservationOperator {
 public:
  virtual ~ObservationOperator() = default;
  /// Throws InputError for an observation that does not fit the mesh (a vertex out of range, ...).
  virtual void check(const Observation& observation) const = 0;
  /// Rows depend on the observation alone, so predictions for different u line up. NaN where the model has no counterpart.
  virtual Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const = 0;
  /// Mesh nodes that a prediction of it depends on.
  virtual std::vector<int> nodes(const Observation& observation) const = 0;
  /// Outline of the model in the sensor's image, as separate segments (u0, v0, u1, v1) [pixel]; empty for other sensors.
  virtual Eigen::Matrix4Xd outline(const Observation&, const Eigen::VectorXd&) const { return {}; }
};

/// One operator for each entry of the model file's `observations`, in that order. Throws InputError for an entry that does
/// not fit the model.
std::vector<std::unique_ptr<ObservationOperator>> make_observation_operators(const Model& model);

std::unique_ptr<ObservationOperator> make_vertex_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_marker_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_point_operator(const Model& model, const ObservationSettings& settings);
std::unique_ptr<ObservationOperator> make_contour_operator(const Model& model, const ObservationSettings& settings);

/// Nodes that predictions of these frames depend on, ascending.
std::vector<int> observed_nodes(const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                                const std::vector<Frame>& frames);

/// Joins the predictions of a frame's observations.
Prediction concatenate(std::vector<Prediction> parts);

}  // namespace tissue_stiffness
