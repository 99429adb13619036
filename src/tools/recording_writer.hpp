#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "types/pending_file.hpp"

namespace tissue_stiffness {

/// Writes sensor data into a rosbag, which exists once it is closed. A message's stamp is its record time.
class RecordingWriter {
 public:
  /// Opens the file. Throws InputError when it cannot be written.
  explicit RecordingWriter(const std::string& file);

  /// Writes points in the frame `model`. `ids` become the integer field `id_name`, unless that is empty.
  void write_cloud(const std::string& topic, const ros::Time& stamp, const Eigen::Matrix3Xd& points,
                   const Eigen::VectorXi& ids, const std::string& id_name);
  void write_load(const LoadInput& input, const ros::Time& stamp, const Eigen::VectorXd& value);
  /// Writes an 8-bit image, grey or in blue, green and red, with its CameraInfo.
  void write_image(const std::string& topic, const std::string& info_topic, const std::string& frame,
                   const ros::Time& stamp, const Camera& camera, const cv::Mat& image);
  /// Writes a sensor's pose on /tf_static.
  void write_pose(const std::string& frame, const ros::Time& stamp, const Eigen::Isometry3d& model_from_sensor);
  /// Closes the bag and puts it in place. Throws InputError as PendingFile does.
  void close();

 private:
  PendingFile file_;
  rosbag::Bag bag_;
};

}  // namespace tissue_stiffness
