#include "tools/recorded_poses.hpp"

#include <tf2/exceptions.h>

#include <utility>

#include "nodes/sensor_conversions.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kMemory = 60.0;  // [s] of /tf kept; more than any frame lags behind

}  // namespace

RecordedPoses::RecordedPoses(std::string model_frame)
    : model_frame_(std::move(model_frame)), poses_(ros::Duration(kMemory)) {}

void RecordedPoses::add(const tf2_msgs::TFMessage& message, const std::string& topic, bool is_static) {
  for (geometry_msgs::TransformStamped pose : message.transforms) {
    to_isometry(pose.transform, topic + ": " + pose.child_frame_id);  // tf2 only logs what is wrong
    pose.header.frame_id = plain_frame(pose.header.frame_id);
    pose.child_frame_id = plain_frame(pose.child_frame_id);
    poses_.setTransform(pose, topic, is_static);
  }
}

std::optional<Eigen::Isometry3d> RecordedPoses::model_from(const std_msgs::Header& header, std::string& reason) const {
  const std::string frame = plain_frame(header.frame_id);
  if (frame == model_frame_) return Eigen::Isometry3d::Identity();
  try {
    if (frame.empty()) throw tf2::InvalidArgumentException("the message's frame_id is empty");
    return to_isometry(poses_.lookupTransform(model_frame_, frame, header.stamp).transform, "/tf: " + frame);
  } catch (const tf2::TransformException& error) {
    reason = "no pose of frame '" + frame + "' in '" + model_frame_ + "': " + error.what();
    return std::nullopt;
  }
}

}  // namespace tissue_stiffness
