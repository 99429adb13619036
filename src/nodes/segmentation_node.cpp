#include "nodes/segmentation_node.hpp"

#include <cv_bridge/cv_bridge.h>
#include <ros/ros.h>

#include <boost/make_shared.hpp>

#include "nodes/message_conversions.hpp"
#include "nodes/node_keys.hpp"
#include "nodes/numbered_topic.hpp"
#include "nodes/sensor_conversions.hpp"
#include "segmentation/overlay.hpp"
#include "settings/read_sections.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::size_t kMostWaiting = 30;  // images for the model's outline: an estimator that is behind, or skips frames

/// Returns contour `number` of a model, or null when the model has no contour. Throws InputError for a number out of range.
const ObservationSettings* find_contour(const ModelSettings& model, int number) {
  int contours = 0;
  for (const ObservationSettings& observation : model.observations) {
    if (observation.kind == ObservationKind::contour && ++contours == number) return &observation;
  }
  if (contours == 0) return nullptr;
  throw InputError(model.name + ": contour_number", std::to_string(number), "1 to " + std::to_string(contours));
}

const KeySpec& key(const std::string& name) {
  return find_key(node_keys("segmentation_node"), name);
}

}  // namespace

SegmentationNode::SegmentationNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : SegmentationNode(node, read_node_settings(private_node, names_of(node_keys("segmentation_node")))) {}

SegmentationNode::SegmentationNode(const ros::NodeHandle& node, const NodeSettings& settings)
    : node_(node),
      transport_(node_),
      diagnostics_(node_, "segmentation", read_number(settings.own, key("diagnostic_period"))),
      queue_size_(static_cast<std::uint32_t>(read_number(settings.own, key("queue_size")))) {
  const int number = static_cast<int>(read_number(settings.own, key("contour_number")));
  image_topic_ = node_.resolveName("image");
  camera_info_topic_ = node_.resolveName("camera_info");
  if (settings.own.has("segmentation")) {
    segmentation_ = read_segmentation(settings.own.at("segmentation"));
    settings.own.at("segmentation").require_all_read();
  } else {
    const ModelSettings model = read_model(settings.model, settings.directory);
    follow_features(model);
    const ObservationSettings* contour = find_contour(model, number);
    if (contour == nullptr) {
      if (tracks_.empty()) ROS_INFO("the model observes no contour: nothing to segment");
      return;
    }
    segmentation_ = contour->segmentation;
    if (image_topic_ == node_.resolveName("image", false)) image_topic_ = contour->topic;
    if (camera_info_topic_ == node_.resolveName("camera_info", false)) camera_info_topic_ = contour->camera_info;
  }
  segmenter_ = make_segmenter(segmentation_);
  const auto on_listener = [this](const ros::SingleSubscriberPublisher&) { connect(); };
  const auto on_viewer = [this](const image_transport::SingleSubscriberPublisher&) { connect(); };
  contour_publisher_ = node_.advertise<ContourMessage>("contour", queue_size_, on_listener, on_listener);
  overlay_publisher_ = transport_.advertise("overlay", 10, on_viewer, on_viewer);
  predicted_subscriber_ = node_.subscribe("predicted_contour", queue_size_, &SegmentationNode::on_predicted, this);
}

void SegmentationNode::follow_features(const ModelSettings& model) {
  for (const ObservationSettings& observation : model.observations) {
    if (observation.kind != ObservationKind::tracks) continue;
    const std::string topic = numbered_topic("tracks", tracks_.size() + 1);
    tracks_.push_back(std::make_unique<TrackPublisher>(node_, observation, topic, queue_size_, diagnostics_));
  }
}

void SegmentationNode::connect() {
  if (contour_publisher_.getNumSubscribers() + overlay_publisher_.getNumSubscribers() == 0) {
    image_subscriber_.shutdown();
    camera_info_subscriber_.shutdown();
  } else if (!image_subscriber_) {
    camera_info_subscriber_ = node_.subscribe(camera_info_topic_, 10, &SegmentationNode::on_camera_info, this);
    image_subscriber_ = transport_.subscribe(image_topic_, queue_size_, &SegmentationNode::on_image, this);
  }
}

void SegmentationNode::on_camera_info(const sensor_msgs::CameraInfoConstPtr& message) {
  camera_info_ = message;
}

void SegmentationNode::on_image(const sensor_msgs::ImageConstPtr& message) {
  try {
    require_stamp(message->header, image_topic_);
    const cv::Mat image = to_image(message, segmentation_.kind, image_topic_);
    if (camera_info_) {
      require_image_size(image.size(),
                         cv::Size(static_cast<int>(camera_info_->width), static_cast<int>(camera_info_->height)),
                         image_topic_, camera_info_topic_);
    }
    const Segmentation found = segment(message, image);
    // As a pointer: a subscriber in this process gets this very message.
    if (found.found()) {
      contour_publisher_.publish(boost::make_shared<ContourMessage>(to_message(found.contour, message->header)));
    }
    if (overlay_publisher_.getNumSubscribers() == 0) return waiting_.clear();
    waiting_.push_back({message, image, found.contour});
    const bool awaited = predicted_subscriber_.getNumPublishers() > 0 && found.found();
    const std::size_t most = awaited ? kMostWaiting : 0;
    while (waiting_.size() > most) publish_overlay(nullptr);
  } catch (const std::exception& error) {
    diagnostics_.bad_message(error.what());
  }
}

Segmentation SegmentationNode::segment(const sensor_msgs::ImageConstPtr& message, const cv::Mat& image) {
  const ros::Time stamp = message->header.stamp;
  if (stamp < last_) {  // a recording that starts again
    segmenter_->reset();
    waiting_.clear();
  }
  last_ = stamp;
  const ros::WallTime before = ros::WallTime::now();
  Segmentation found = segmenter_->segment(image, stamp.toSec());
  diagnostics_.time("segment", (ros::WallTime::now() - before).toSec());
  if (found.found()) {
    diagnostics_.count("contours found");
    diagnostics_.state(DiagnosticStatus::OK, "contour found");
  } else {
    ROS_WARN_STREAM_THROTTLE(1.0, "no contour: " << found.reason);
    diagnostics_.count("images without a contour");
    diagnostics_.state(DiagnosticStatus::WARN, "no contour: " + found.reason);
  }
  return found;
}

void SegmentationNode::on_predicted(const ContourConstPtr& message) {
  const ros::Time stamp = message->header.stamp;
  while (!waiting_.empty() && waiting_.front().message->header.stamp < stamp) publish_overlay(nullptr);
  if (!waiting_.empty() && waiting_.front().message->header.stamp == stamp) publish_overlay(message);
}

void SegmentationNode::publish_overlay(const ContourConstPtr& predicted) {
  const Seen seen = std::move(waiting_.front());
  waiting_.pop_front();
  Eigen::Matrix2Xd outline;
  if (predicted && predicted->u.size() == predicted->v.size()) {
    outline.resize(2, static_cast<Eigen::Index>(predicted->u.size()));
    for (Eigen::Index i = 0; i < outline.cols(); ++i) {
      outline.col(i) << predicted->u[static_cast<std::size_t>(i)], predicted->v[static_cast<std::size_t>(i)];
    }
  }
  const cv::Mat canvas = draw_overlay(seen.image, seen.measured, outline);
  overlay_publisher_.publish(cv_bridge::CvImage(seen.message->header, "bgr8", canvas).toImageMsg());
}

}  // namespace tissue_stiffness
