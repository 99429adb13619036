#pragma once

#include <ros/node_handle.h>

#include <string>

#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// The estimator's topics: `stiffness` (latched), `misfit`, `tracked_surface`, `tracked_points`, `predicted_contour`.
class EstimatorOutputs {
 public:
  EstimatorOutputs(ros::NodeHandle node, std::string model_frame);

  /// After each frame that was used. What nobody listens to is not made.
  void publish(const Estimator& estimator, const StepResult& result, const Frame& frame, const ros::Time& stamp) const;

 private:
  std::string model_frame_;
  ros::Publisher stiffness_, misfit_, surface_, points_, outline_;
};

}  // namespace tissue_stiffness
