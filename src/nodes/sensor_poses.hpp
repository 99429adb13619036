#pragma once

#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <string>

#include "nodes/bounded_waits.hpp"
#include "nodes/transform_wait.hpp"

namespace tissue_stiffness {

/// Poses of sensors in the model frame, from /tf and /tf_static. One thread may ask.
class SensorPoses {
 public:
  /// `patience`: how long to wait for a transform, in wall time [s], because simulated time may stand still.
  SensorPoses(std::string model_frame, double patience);

  /// Returns the pose of the header's frame at its stamp. Throws InputError naming `topic` and both frames when there is
  /// none. A sensor without a pose does not hold up the others (see BoundedWaits).
  Eigen::Isometry3d model_from(const std_msgs::Header& header, const std::string& topic);

  const std::string& model_frame() const { return model_frame_; }

 private:
  std::string model_frame_;
  BoundedWaits waits_;  ///< by frame
  tf2_ros::Buffer buffer_;
  TransformWait arrival_;
  tf2_ros::TransformListener listener_;  ///< last member, because its thread uses the ones above
};

}  // namespace tissue_stiffness
