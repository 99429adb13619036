#pragma once

#include <image_transport/image_transport.h>
#include <ros/node_handle.h>

#include <deque>
#include <memory>
#include <vector>

#include "nodes/diagnostics.hpp"
#include "nodes/messages.hpp"
#include "nodes/ros_settings.hpp"
#include "nodes/track_publisher.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Finds the tissue's outline in `image` and publishes it on `contour` with the image's header. On `overlay` it publishes
/// the image with this outline and the model's. If an estimator publishes `predicted_contour`, the overlay waits for the
/// one with the image's stamp. The node works only while it has subscribers, so that it does not consume the first image of
/// a recording that waits for them.
///
/// With a model it also follows the features of all its `tracks`, and publishes them on `tracks`, `tracks_2`, ...
///
/// Private parameters: `segmentation: {kind, ...}`, or `model` (a file or the model's keys), whose contour number
/// `contour_number` (1) is used. With a model the image topic is the model's, unless `image` is remapped. `queue_size`
/// (100), `diagnostic_period` (1 s).
class SegmentationNode {
 public:
  SegmentationNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  int exit_code() const { return 0; }

 private:
  SegmentationNode(const ros::NodeHandle& node, const NodeSettings& settings);
  void follow_features(const ModelSettings& model);
  void connect();
  void on_image(const sensor_msgs::ImageConstPtr& message);
  void on_camera_info(const sensor_msgs::CameraInfoConstPtr& message);
  void on_predicted(const ContourConstPtr& message);
  Segmentation segment(const sensor_msgs::ImageConstPtr& message, const cv::Mat& image);
  /// An image whose overlay waits for the model's outline.
  struct Seen {
    sensor_msgs::ImageConstPtr message;
    cv::Mat image;
    Contour measured;
  };
  /// Publishes the overlay of the image that has waited longest.
  void publish_overlay(const ContourConstPtr& predicted);

  ros::NodeHandle node_;
  image_transport::ImageTransport transport_;
  Diagnostics diagnostics_;
  std::uint32_t queue_size_;
  SegmentationSettings segmentation_;
  std::unique_ptr<Segmenter> segmenter_;  ///< null: the model has no contour
  std::vector<std::unique_ptr<TrackPublisher>> tracks_;
  std::string image_topic_, camera_info_topic_;
  ros::Time last_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  std::deque<Seen> waiting_;
  ros::Publisher contour_publisher_;
  image_transport::Publisher overlay_publisher_;
  image_transport::Subscriber image_subscriber_;
  ros::Subscriber camera_info_subscriber_, predicted_subscriber_;
};

}  // namespace tissue_stiffness
