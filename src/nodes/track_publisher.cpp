#include "nodes/track_publisher.hpp"

#include <ros/ros.h>

#include <boost/make_shared.hpp>

#include "nodes/message_conversions.hpp"
#include "nodes/sensor_conversions.hpp"

namespace tissue_stiffness {

using diagnostic_msgs::DiagnosticStatus;

TrackPublisher::TrackPublisher(const ros::NodeHandle& node, const ObservationSettings& settings, const std::string& topic,
                               std::uint32_t queue_size, Diagnostics& diagnostics)
    : node_(node),
      transport_(node_),
      diagnostics_(diagnostics),
      image_topic_(settings.topic),
      queue_size_(queue_size),
      tracker_(make_feature_tracker(settings.features)) {
  const auto on_listener = [this](const ros::SingleSubscriberPublisher&) { connect(); };
  publisher_ = node_.advertise<FeatureTracksMessage>(topic, queue_size_, on_listener, on_listener);
}

void TrackPublisher::connect() {
  if (publisher_.getNumSubscribers() == 0) {
    subscriber_.shutdown();
  } else if (!subscriber_) {
    subscriber_ = transport_.subscribe(image_topic_, queue_size_, &TrackPublisher::on_image, this);
  }
}

void TrackPublisher::on_image(const sensor_msgs::ImageConstPtr& message) {
  try {
    require_stamp(message->header, image_topic_);
    const ros::Time stamp = message->header.stamp;
    if (stamp < last_) tracker_->reset();  // a recording that starts again
    last_ = stamp;
    const ros::WallTime before = ros::WallTime::now();
    const TrackedFeatures found = tracker_->track(to_image(message, image_topic_), stamp.toSec());
    diagnostics_.time("track", (ros::WallTime::now() - before).toSec());
    if (!found.found()) {
      ROS_WARN_STREAM_THROTTLE(1.0, "no features: " << found.reason);
      diagnostics_.count("images without features");
      diagnostics_.state(DiagnosticStatus::WARN, "no features: " + found.reason);
      return;
    }
    diagnostics_.count("images with features");
    diagnostics_.state(DiagnosticStatus::OK, std::to_string(found.tracks.size()) + " features");
    // As a pointer: a subscriber in this process gets this very message.
    publisher_.publish(boost::make_shared<FeatureTracksMessage>(to_message(found.tracks, message->header)));
  } catch (const std::exception& error) {
    diagnostics_.bad_message(error.what());
  }
}

}  // namespace tissue_stiffness
