#pragma once

#include <std_msgs/Header.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace tissue_stiffness {

/// The poses of /tf and /tf_static in a recording.
class RecordedPoses {
 public:
  explicit RecordedPoses(std::string model_frame);

  /// Throws InputError, which names `topic`, for a pose that is none.
  void add(const tf2_msgs::TFMessage& message, const std::string& topic, bool is_static);
  /// Returns the pose of the message's frame in the model's; nothing, and the `reason`, where none is known at its stamp.
  std::optional<Eigen::Isometry3d> model_from(const std_msgs::Header& header, std::string& reason) const;
  const std::string& model_frame() const { return model_frame_; }

 private:
  std::string model_frame_;
  tf2::BufferCore poses_;
};

}  // namespace tissue_stiffness
