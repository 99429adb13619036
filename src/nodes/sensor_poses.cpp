#include "nodes/sensor_poses.hpp"

#include <ros/ros.h>

#include <chrono>
#include <thread>

#include "nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

InputError no_pose(const std::string& topic, const std::string& found, const std::string& reason) {
  return {topic + ": header.frame_id", found + " (" + reason + ")", "a pose on /tf or /tf_static at the stamp"};
}

}  // namespace

SensorPoses::SensorPoses(std::string model_frame, double patience)
    : model_frame_(std::move(model_frame)),
      waits_(std::chrono::duration_cast<BoundedWaits::Clock::duration>(std::chrono::duration<double>(patience))),
      listener_(buffer_) {}

Eigen::Isometry3d SensorPoses::model_from(const std_msgs::Header& header, const std::string& topic) {
  const std::string frame = plain_frame(header.frame_id);
  if (frame == model_frame_) return Eigen::Isometry3d::Identity();
  if (frame.empty()) {
    throw InputError(topic + ": header.frame_id", "''", model_frame_ + ", or a frame with a pose on /tf or /tf_static");
  }
  using Clock = BoundedWaits::Clock;
  const Clock::time_point begun = Clock::now(), until = waits_.until(frame, begun);
  std::string reason;
  while (!buffer_.canTransform(model_frame_, frame, header.stamp, ros::Duration(0), &reason)) {
    if (Clock::now() >= until || !ros::ok()) {
      waits_.in_vain(frame, begun, Clock::now());
      throw no_pose(topic, frame + " without a pose in " + model_frame_, reason);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  try {
    return to_isometry(buffer_.lookupTransform(model_frame_, frame, header.stamp).transform, "/tf: " + frame);
  } catch (const tf2::TransformException& error) {
    throw no_pose(topic, frame, error.what());
  }
}

}  // namespace tissue_stiffness
