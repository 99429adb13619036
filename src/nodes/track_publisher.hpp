#pragma once

#include <image_transport/image_transport.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "nodes/diagnostics.hpp"
#include "nodes/messages.hpp"
#include "segmentation/feature_tracker.hpp"

namespace tissue_stiffness {

/// Follows the features of one of the model's observations and publishes them with the image's header. The first image is
/// the reference, and so is the first one of a recording that starts again. It works only while it has subscribers, so that
/// it does not consume the first image of a recording that waits for them.
class TrackPublisher {
 public:
  TrackPublisher(const ros::NodeHandle& node, const ObservationSettings& settings, const std::string& topic,
                 std::uint32_t queue_size, Diagnostics& diagnostics);

 private:
  void connect();
  void on_image(const sensor_msgs::ImageConstPtr& message);

  ros::NodeHandle node_;
  image_transport::ImageTransport transport_;
  Diagnostics& diagnostics_;
  std::string image_topic_;
  std::uint32_t queue_size_;
  std::unique_ptr<FeatureTracker> tracker_;
  ros::Time last_;
  ros::Publisher publisher_;
  image_transport::Subscriber subscriber_;
};

}  // namespace tissue_stiffness
