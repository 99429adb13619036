#pragma once

#include <ros/node_handle.h>

#include <map>
#include <string>

#include "nodes/model_outline.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// The estimator's topics: `stiffness` (latched), `misfit`, `tracked_surface`, `tracked_points` and `measured_points`. For
/// each contour that the model observes there is `predicted_contour` (then `predicted_contour_2`, ...), the model's outline
/// in its image.
class EstimatorOutputs {
 public:
  EstimatorOutputs(ros::NodeHandle node, std::string model_frame);

  /// Prepares the topics before the first frame on this mesh.
  void prepare(const ModelSettings& settings, const TetMesh& mesh);

  /// Sets the misfit from which the surface is red [standard deviations of the noise].
  void set_colour_limit(double sigmas) { colour_limit_ = sigmas; }

  /// Publishes after each frame that was used. Messages without a subscriber are not made.
  void publish(const Estimator& estimator, const StepResult& result, const Frame& frame, const ros::Time& stamp) const;
  /// Publishes the estimate alone, when it changed without a frame.
  void publish(const Estimate& estimate, const ros::Time& stamp) const;

 private:
  void publish_outline(const Estimator& estimator, const Frame& frame, const std_msgs::Header& header) const;

  ros::NodeHandle node_;
  std::string model_frame_;
  double colour_limit_ = 3.0;
  ros::Publisher stiffness_, misfit_, surface_, points_, measured_;
  std::map<int, ModelOutline> outlines_;          ///< by index in the model's list of observations
  std::map<int, ros::Publisher> outline_topics_;  ///< by the same index
};

}  // namespace tissue_stiffness
