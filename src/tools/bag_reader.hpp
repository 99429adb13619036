#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/FluidPressure.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tools/recorded_observations.hpp"
#include "tools/recorded_poses.hpp"
#include "tools/recorded_stamps.hpp"

namespace tissue_stiffness {

/// Reads what a model needs from a rosbag: frames in the order of their header stamps, with their loads. Observations with
/// one stamp make one frame. Images are segmented here, and poses come from /tf and /tf_static.
///
/// Throws InputError for a file that is missing or not a bag, a topic that is absent or of another type, and a message
/// whose content is wrong. An image without an outline, or a sensor without a pose at the stamp, costs only this
/// observation. A message is late when its stamp has already passed (0.5 s or 256 frames behind the newest). Late messages,
/// and those whose stamps are broken (see RecordedStamps), are counted and left out.
class BagReader {
 public:
  BagReader(const std::string& file, const ModelSettings& settings, std::string model_frame = "model");

  /// Returns the earliest stamp on the model's topics [s].
  double first_stamp() const { return first_stamp_.toSec(); }
  /// Returns the number of frames, at most.
  std::size_t frame_count() const { return frame_count_; }
  /// Tells which vertices there are, and where the body is, once the mesh is known.
  void set_mesh(const TetMesh& mesh) { observations_.set_mesh(mesh); }

  /// Segments only about `most` images of each sensor, evenly over the bag.
  void thin_images(std::size_t most);

  /// Returns the next instant; nothing at the end.
  std::optional<Instant> next();

  int late() const { return late_; }
  int broken_stamps() const { return stamps_.broken(); }
  /// Names topic and jump of the last one of them; empty: none.
  const std::string& last_broken_stamp() const { return stamps_.last_broken(); }

  /// Returns reduced images of the frames read so far, at most 40 for each sensor, for reports.
  const std::vector<Picture>& pictures() const { return observations_.pictures(); }
  std::vector<double> picture_stamps() const;

 private:
  void open();
  void check_topics();
  void require_topic(const std::string& topic, const std::string& type);
  std::vector<std::string> topics() const;
  void read_static_poses();

  bool read_message();
  void add_force(const rosbag::MessageInstance& message, int source);
  void add_measurement(const std::string& topic, const ros::Time& stamp, RecordedMeasurement measurement);
  void add_load(const rosbag::MessageInstance& message, const LoadInput& input);
  template <typename Message>
  void add_posed_load(const rosbag::MessageInstance& message, const std::string& topic);
  void add_load(const std::string& topic, const ros::Time& stamp, const LoadSample& sample);
  void add_poses(const rosbag::MessageInstance& message, bool is_static);
  void note_stamp(const ros::Time& stamp);
  bool front_is_complete() const;

  std::string file_;
  ModelSettings settings_;
  std::vector<LoadInput> load_inputs_;
  rosbag::Bag bag_;
  rosbag::View view_;
  rosbag::View::iterator next_message_;
  std::size_t frame_count_ = 0;
  int late_ = 0;
  RecordedPoses poses_;
  RecordedObservations observations_;
  RecordedStamps stamps_;
  std::map<int, RateLimit> limits_;  ///< of forces, by index of the observation
  std::map<ros::Time, std::vector<RecordedMeasurement>> pending_;
  std::vector<LoadSample> loads_;
  ros::Time first_stamp_ = ros::TIME_MAX, newest_, last_returned_;
};

}  // namespace tissue_stiffness
