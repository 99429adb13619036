#pragma once

#include <ros/node_handle.h>

#include <map>
#include <string>

#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/nodes/model_outline.hpp"

namespace tissue_stiffness {

/// The estimator's topics: `stiffness` (latched), `misfit`, `tracked_surface`, `tracked_points`,
/// `measured_points`, and for each contour that the model observes `predicted_contour` (then `predicted_contour_2`, ...):
/// the model's outline in its image.
class EstimatorOutputs {
 public:
  EstimatorOutputs(ros::NodeHandle node, std::string model_frame);

  /// Before the first frame on this mesh.
  void prepare(const ModelSettings& settings, const TetMesh& mesh);

  /// After each frame that was used. What nobody listens to is not made.
  void publish(const Estimator& estimator, const StepResult& result, const Frame& frame, const ros::Time& stamp) const;
  /// The estimate alone, when no frame came with it.
  void publish(const Estimate& estimate, const ros::Time& stamp) const;

 private:
  void publish_outline(const Estimator& estimator, const Frame& frame, const std_msgs::Header& header) const;

  ros::NodeHandle node_;
  std::string model_frame_;
  ros::Publisher stiffness_, misfit_, surface_, points_, measured_;
  std::map<int, ModelOutline> outlines_;          ///< by row of the model's observations
  std::map<int, ros::Publisher> outline_topics_;  ///< the same
};

}  // namespace tissue_stiffness
