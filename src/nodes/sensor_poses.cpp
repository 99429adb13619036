#include "nodes/sensor_poses.hpp"

#include <chrono>

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
      arrival_(buffer_),
      listener_(buffer_) {}

Eigen::Isometry3d SensorPoses::model_from(const std_msgs::Header& header, const std::string& topic) {
  const std::string frame = plain_frame(header.frame_id);
  if (frame == model_frame_) return Eigen::Isometry3d::Identity();
  if (frame.empty()) {
    throw InputError(topic + ": header.frame_id", "''", model_frame_ + ", or a frame with a pose on /tf or /tf_static");
  }
  const auto begun = BoundedWaits::Clock::now();
  std::string reason;
  if (!arrival_.wait(model_frame_, frame, header.stamp, waits_.until(frame, begun), reason)) {
    waits_.in_vain(frame, begun, BoundedWaits::Clock::now());
    throw no_pose(topic, frame + " without a pose in " + model_frame_, reason);
  }
  try {
    return to_isometry(buffer_.lookupTransform(model_frame_, frame, header.stamp).transform, "/tf: " + frame);
  } catch (const tf2::TransformException& error) {
    throw no_pose(topic, frame, error.what());
  }
}

}  // namespace tissue_stiffness
