#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2/buffer_core.h>

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/replay.hpp"

namespace tissue_stiffness {

/// One instant of a recording. `frame` is empty when nothing in it could be used; `reason` then says why.
struct Instant {
  Frame frame;
  std::vector<LoadSample> loads;  ///< read since the last instant: up to the frame's stamp and a little beyond
  std::string reason;
  double segment_seconds = 0.0;
};

/// Reads what a model asks for from a rosbag: frames in the order of their header stamps, with the loads that drive them.
/// Observations of one stamp make one frame. Images are segmented here; poses come from /tf and /tf_static.
///
/// Throws InputError for a file that is missing or no bag, a topic that is absent or of another type, a message whose
/// content is wrong. An image without an outline and a sensor without a pose at the stamp only cost that observation. A
/// message that comes when its stamp has already passed (0.5 s or 256 frames behind the newest) is late: counted and left
/// out.
class BagReader {
 public:
  BagReader(const std::string& file, const ModelSettings& settings, std::string model_frame = "model");

  /// Earliest stamp on the model's topics [s].
  double first_stamp() const { return first_stamp_.toSec(); }
  /// How many frames there are, at most.
  std::size_t frame_count() const { return frame_count_; }
  /// Upper bound of the field `vertex`, once the mesh is known.
  void set_vertex_count(int count) { vertex_count_ = count; }

  /// Segments about `most` images of each sensor, evenly over the bag, and passes over the others.
  void thin_images(std::size_t most) { image_stride_ = (frame_count_ + most - 1) / most; }

  /// Nothing at the end.
  std::optional<Instant> next();

  int late() const { return late_; }

  /// Images of the frames read so far, small, at most 40 a sensor, for showing.
  const std::vector<Picture>& pictures() const { return pictures_; }
  std::vector<double> picture_stamps() const;

 private:
  struct Measurement {
    int source;
    sensor_msgs::PointCloud2ConstPtr cloud;
    sensor_msgs::ImageConstPtr image;
  };

  void open();
  void check_topics();
  void require_topic(const std::string& topic, const std::string& type);
  std::vector<std::string> topics() const;
  void read_static_poses();

  bool read_message();
  void add_measurement(const ros::Time& stamp, Measurement measurement);
  void add_load(const rosbag::MessageInstance& message, const LoadInput& input);
  void add_poses(const rosbag::MessageInstance& message, bool is_static);
  void note_stamp(const ros::Time& stamp);
  bool front_is_complete() const;

  void convert(const Measurement& measurement, Instant& instant);
  void segment(const Measurement& measurement, Instant& instant);
  void keep_picture(const Measurement& measurement, const cv::Mat& image);
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
  int late_ = 0;

  tf2::BufferCore poses_;
  std::map<int, std::unique_ptr<Segmenter>> segmenters_;  ///< by source
  std::map<int, std::size_t> images_;                     ///< seen, by source
  std::map<int, std::size_t> come_;                       ///< those passed over, too
  std::vector<Picture> pictures_;
  std::map<std::string, std::map<ros::Time, sensor_msgs::CameraInfoConstPtr>> cameras_;
  std::map<ros::Time, std::vector<Measurement>> pending_;
  std::vector<LoadSample> loads_;
  ros::Time first_stamp_ = ros::TIME_MAX, newest_, last_returned_;
};

}  // namespace tissue_stiffness
