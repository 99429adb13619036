#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2/buffer_core.h>

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/stamp_filter.hpp"
#include "observation/body_points.hpp"
#include "observation/feature_anchors.hpp"
#include "segmentation/feature_tracker.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// One instant of a recording. `frame` is empty when nothing in it could be used; `reason` then says why.
struct Instant {
  Frame frame;
  std::vector<LoadSample> loads;  ///< loads read since the last instant, up to the frame's stamp and a little later
  std::string reason;
  double segment_seconds = 0.0;
};

/// Reads what a model needs from a rosbag: frames in the order of their header stamps, with their loads. Observations with
/// one stamp make one frame. Images are segmented here, and poses come from /tf and /tf_static.
///
/// Throws InputError for a file that is missing or not a bag, a topic that is absent or of another type, and a message
/// whose content is wrong. An image without an outline, or a sensor without a pose at the stamp, costs only this
/// observation. A message is late when its stamp has already passed (0.5 s or 256 frames behind the newest). Late messages,
/// and those whose stamps are broken (see StampFilter), are counted and left out.
class BagReader {
 public:
  BagReader(const std::string& file, const ModelSettings& settings, std::string model_frame = "model");

  /// Returns the earliest stamp on the model's topics [s].
  double first_stamp() const { return first_stamp_.toSec(); }
  /// Returns the number of frames, at most.
  std::size_t frame_count() const { return frame_count_; }
  /// Tells which vertices there are, and where the body is, once the mesh is known.
  void set_mesh(const TetMesh& mesh);

  /// Segments only about `most` images of each sensor, evenly over the bag.
  void thin_images(std::size_t most) { image_stride_ = (frame_count_ + most - 1) / most; }

  /// Returns the next instant; nothing at the end.
  std::optional<Instant> next();

  int late() const { return late_; }
  int broken_stamps() const;
  /// Names topic and jump of the last one of them; empty: none.
  const std::string& last_broken_stamp() const { return last_broken_; }

  /// Returns reduced images of the frames read so far, at most 40 for each sensor, for reports.
  const std::vector<Picture>& pictures() const { return pictures_; }
  std::vector<double> picture_stamps() const;

 private:
  struct Measurement {
    int source;
    sensor_msgs::PointCloud2ConstPtr cloud;
    sensor_msgs::ImageConstPtr image;
    geometry_msgs::WrenchStampedConstPtr wrench;
  };

  void open();
  void check_topics();
  void require_topic(const std::string& topic, const std::string& type);
  std::vector<std::string> topics() const;
  void read_static_poses();

  using Put = std::function<void()>;
  using Filter = StampFilter<Put>;

  bool read_message();
  /// Calls `put` once the stamp is believed.
  void accept(const std::string& topic, const ros::Time& stamp, Put put);
  void believe(Filter& filter, const std::vector<Filter::Stamped>& believed);
  void release_agreeing();
  void release_first();
  void release_last();
  void add_force(const rosbag::MessageInstance& message, int source);
  void add_measurement(const std::string& topic, const ros::Time& stamp, Measurement measurement);
  void add_load(const rosbag::MessageInstance& message, const LoadInput& input);
  template <typename Message>
  void add_posed_load(const rosbag::MessageInstance& message, const std::string& topic);
  void add_load(const std::string& topic, const ros::Time& stamp, const LoadSample& sample);
  void add_poses(const rosbag::MessageInstance& message, bool is_static);
  void note_stamp(const ros::Time& stamp);
  bool front_is_complete() const;

  void convert(const Measurement& measurement, Instant& instant);
  void observe_image(const Measurement& measurement, Instant& instant);
  void segment(int source, const cv::Mat& image, const std::shared_ptr<Camera>& camera, Instant& instant);
  void track(int source, const cv::Mat& image, const Camera& camera, Instant& instant);
  void keep_picture(const Measurement& measurement, const cv::Mat& image, const Camera& camera);
  sensor_msgs::CameraInfoConstPtr camera_info(const std::string& topic, const ros::Time& stamp) const;
  std::optional<Eigen::Isometry3d> pose(const std_msgs::Header& header, std::string& reason) const;

  std::string file_;
  ModelSettings settings_;
  std::string model_frame_;
  std::vector<LoadInput> load_inputs_;
  rosbag::Bag bag_;
  rosbag::View view_;
  rosbag::View::iterator next_message_;
  std::size_t frame_count_ = 0, image_stride_ = 1;
  int vertex_count_ = std::numeric_limits<int>::max();
  std::map<int, BodyPoints> body_points_;  ///< by index of the observation
  std::map<int, FeatureAnchors> anchors_;  ///< by index of the observation
  int late_ = 0;
  double now_ = 0.0;  ///< when the recorder received the last message [s]
  std::string last_broken_;
  std::map<std::string, Filter> filters_;

  tf2::BufferCore poses_;
  std::map<int, std::unique_ptr<Segmenter>> segmenters_;     ///< by index of the observation
  std::map<int, std::unique_ptr<FeatureTracker>> trackers_;  ///< by index of the observation
  std::map<int, std::size_t> images_;                        ///< images that were segmented, by index of the observation
  std::map<int, RateLimit> limits_;                          ///< of forces, by index of the observation
  std::map<int, std::size_t> come_;                          ///< all images, by index of the observation
  std::vector<Picture> pictures_;
  std::map<std::string, std::map<ros::Time, sensor_msgs::CameraInfoConstPtr>> cameras_;
  std::map<ros::Time, std::vector<Measurement>> pending_;
  std::vector<LoadSample> loads_;
  ros::Time first_stamp_ = ros::TIME_MAX, newest_, last_returned_;
};

}  // namespace tissue_stiffness
