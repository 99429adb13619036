#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "observation/body_points.hpp"
#include "observation/feature_anchors.hpp"
#include "segmentation/feature_tracker.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tools/recorded_poses.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// One instant of a recording. `frame` is empty when nothing in it could be used; `reason` then says why.
struct Instant {
  Frame frame;
  std::vector<LoadSample> loads;  ///< loads read since the last instant, up to the frame's stamp and a little later
  std::string reason;
  double segment_seconds = 0.0;
};

/// A message of one sensor; one of the pointers is set.
struct RecordedMeasurement {
  int source = 0;  ///< index of the observation
  sensor_msgs::PointCloud2ConstPtr cloud;
  sensor_msgs::ImageConstPtr image;
  geometry_msgs::WrenchStampedConstPtr wrench;
};

/// Makes observations of a recording's messages: it converts clouds and forces, segments images and follows features.
class RecordedObservations {
 public:
  /// `file` is named in errors.
  RecordedObservations(std::string file, const ModelSettings& settings, const RecordedPoses& poses);

  /// Tells which vertices there are, and where the body is, once the mesh is known.
  void set_mesh(const TetMesh& mesh);
  /// Sets how many images of a sensor make one that is used, and how many make one that is kept for reports.
  void thin_images(std::size_t used, std::size_t kept) { used_stride_ = used, kept_stride_ = kept; }
  void add_camera_info(const std::string& topic, const sensor_msgs::CameraInfoConstPtr& info) {
    cameras_[topic][info->header.stamp] = info;
  }

  /// Adds what the measurement shows to the instant's frame, or the reason why it shows nothing. Throws InputError for a
  /// message whose content is wrong.
  void add(const RecordedMeasurement& measurement, Instant& instant);

  /// Returns reduced images of the frames so far, for reports.
  const std::vector<Picture>& pictures() const { return pictures_; }

 private:
  void add_cloud(const RecordedMeasurement& measurement, Instant& instant);
  void add_force(const RecordedMeasurement& measurement, Instant& instant);
  void add_image(const RecordedMeasurement& measurement, Instant& instant);
  void segment(int source, const cv::Mat& image, const std::shared_ptr<Camera>& camera, Instant& instant);
  void track(int source, const cv::Mat& image, const Camera& camera, Instant& instant);
  void keep_picture(const RecordedMeasurement& measurement, const cv::Mat& image, const Camera& camera);
  sensor_msgs::CameraInfoConstPtr camera_info(const std::string& topic, const ros::Time& stamp) const;
  const ObservationSettings& settings_of(int source) const {
    return settings_.observations[static_cast<std::size_t>(source)];
  }

  std::string file_;
  const ModelSettings& settings_;
  const RecordedPoses& poses_;
  std::size_t used_stride_ = 1, kept_stride_ = 1;
  int vertex_count_ = std::numeric_limits<int>::max();
  std::map<std::string, std::map<ros::Time, sensor_msgs::CameraInfoConstPtr>> cameras_;
  // By index of the observation:
  std::map<int, BodyPoints> body_points_;
  std::map<int, FeatureAnchors> anchors_;
  std::map<int, std::unique_ptr<Segmenter>> segmenters_;
  std::map<int, std::unique_ptr<FeatureTracker>> trackers_;
  std::map<int, std::size_t> images_, used_images_;  ///< number of those that came, and of those that were used
  std::vector<Picture> pictures_;
};

}  // namespace tissue_stiffness
