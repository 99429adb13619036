#pragma once

#include <ros/node_handle.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "nodes/diagnostics.hpp"
#include "nodes/frame_queue.hpp"
#include "nodes/messages.hpp"
#include "nodes/sensor_conversions.hpp"
#include "nodes/sensor_poses.hpp"
#include "observation/body_points.hpp"
#include "observation/feature_anchors.hpp"

namespace tissue_stiffness {

/// Returns the loads that the model's effects need on topics.
std::vector<LoadInput> load_topics(const ModelSettings& settings);

/// The estimator's subscriptions. Callbacks only queue messages; the worker converts them.
///
/// The first contour of the model comes on `contour`, further ones on `contour_2`, `contour_3`, ... Tracks come on
/// `tracks`, `tracks_2`, ...
class EstimatorInputs {
 public:
  EstimatorInputs(const ros::NodeHandle& node, const ModelSettings& settings, SensorPoses& poses, FrameQueue& queue,
                  Diagnostics& diagnostics);

  /// Subscribes to observations and loads, the first time it is called.
  void listen(std::uint32_t queue_size);

  /// Tells which vertices there are, and where the body is. The worker calls it, between two frames.
  void set_mesh(const TetMesh& mesh);

 private:
  void listen_cloud(int source, std::uint32_t queue_size);
  void listen_reaction(int source, std::uint32_t queue_size);
  void listen_contour(int source, const std::string& topic, std::uint32_t queue_size);
  void listen_tracks(int source, const std::string& topic, std::uint32_t queue_size);
  void listen_camera(int source);
  void listen_load(const LoadInput& input, std::uint32_t queue_size);
  template <typename Message>
  void listen_posed_load(const std::string& topic, std::uint32_t queue_size);
  Observation observe_contour(const ContourMessage& message, int source, const std::string& topic) const;
  Observation observe_tracks(const FeatureTracksMessage& message, int source, const std::string& topic);
  /// Returns the camera of an image. Throws InputError where it is not known, or has another size.
  Camera camera_of(const std_msgs::Header& header, int width, int height, int source, const std::string& topic) const;
  template <typename Message, typename Add>
  void subscribe(const std::string& topic, std::uint32_t queue_size, Add add);

  ros::NodeHandle node_;
  const ModelSettings& settings_;
  SensorPoses& poses_;
  FrameQueue& queue_;
  Diagnostics& diagnostics_;
  int vertex_count_ = 0;
  std::map<int, BodyPoints> body_points_;  ///< by index of the observation
  std::map<int, FeatureAnchors> anchors_;  ///< by index of the observation
  mutable std::mutex camera_mutex_;
  std::map<std::string, sensor_msgs::CameraInfoConstPtr> cameras_;  ///< by topic
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace tissue_stiffness
