#include "tissue_stiffness/nodes/segmentation_node.hpp"

#include <cv_bridge/cv_bridge.h>
#include <ros/ros.h>

#include "tissue_stiffness/nodes/message_conversions.hpp"
#include "tissue_stiffness/nodes/sensor_conversions.hpp"
#include "tissue_stiffness/segmentation/overlay.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using diagnostic_msgs::DiagnosticStatus;

SegmentationSettings read_segmentation(const Value& map) {
  SegmentationSettings out;
  out.kind = map.at("kind").as_choice({"silhouette", "cavity"}) == "cavity" ? SegmentationSettings::Kind::cavity
                                                                            : SegmentationSettings::Kind::silhouette;
  if (map.has("seed")) {
    const auto& seed = map.at("seed").items();
    if (seed.size() != 2) throw InputError(map.at("seed").path(), map.at("seed").shown(), "[u, v] [pixel]");
    out.seed = Eigen::Vector2d(seed[0].as_number(0, 1e6, "pixel"), seed[1].as_number(0, 1e6, "pixel"));
  }
  map.require_all_read();
  return out;
}

/// Contour `number` of a model; null when it has none.
const ObservationSettings* find_contour(const ModelSettings& model, int number) {
  int contours = 0;
  for (const ObservationSettings& observation : model.observations) {
    if (observation.kind == ObservationSettings::Kind::contour && ++contours == number) return &observation;
  }
  if (contours == 0) return nullptr;
  throw InputError(model.name + ": contour_number", std::to_string(number), "1 to " + std::to_string(contours));
}

std::string size_of(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

SegmentationNode::SegmentationNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node), transport_(node_), diagnostics_(node_, "segmentation") {
  const NodeSettings settings = read_node_settings(private_node, {"segmentation", "contour_number", "queue_size"});
  queue_size_ = static_cast<std::uint32_t>(settings.own.number_or("queue_size", 100, 1, 1e4, "images"));
  const int number = static_cast<int>(settings.own.number_or("contour_number", 1, 1, 100, ""));
  image_topic_ = node_.resolveName("image");
  camera_info_topic_ = node_.resolveName("camera_info");
  if (settings.own.has("segmentation")) {
    segmenter_ = make_segmenter(read_segmentation(settings.own.at("segmentation")));
  } else {
    const ModelSettings model = read_model(settings.model, settings.directory);
    const ObservationSettings* contour = find_contour(model, number);
    if (contour == nullptr) {
      ROS_INFO("the model observes no contour: nothing to segment");
      return;
    }
    segmenter_ = make_segmenter(contour->segmentation);
    if (image_topic_ == node_.resolveName("image", false)) image_topic_ = contour->topic;
    if (camera_info_topic_ == node_.resolveName("camera_info", false)) camera_info_topic_ = contour->camera_info;
  }
  const auto on_listener = [this](const ros::SingleSubscriberPublisher&) { connect(); };
  const auto on_viewer = [this](const image_transport::SingleSubscriberPublisher&) { connect(); };
  contour_publisher_ = node_.advertise<ContourMessage>("contour", queue_size_, on_listener, on_listener);
  overlay_publisher_ = transport_.advertise("overlay", 10, on_viewer, on_viewer);
  predicted_subscriber_ = node_.subscribe("predicted_contour", 1, &SegmentationNode::on_predicted, this);
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
    const cv::Mat image = to_image(message, image_topic_);
    if (camera_info_ && (camera_info_->width != message->width || camera_info_->height != message->height)) {
      throw InputError(image_topic_, size_of(message->width, message->height) + " pixels",
                       size_of(camera_info_->width, camera_info_->height) + " as in " + camera_info_topic_);
    }
    const Segmentation found = segment(message, image);
    if (found.found()) contour_publisher_.publish(to_message(found.contour, message->header));
    if (overlay_publisher_.getNumSubscribers() > 0) publish_overlay(*message, image, found.contour);
  } catch (const InputError& error) {
    diagnostics_.bad_message(error.what());
  }
}

Segmentation SegmentationNode::segment(const sensor_msgs::ImageConstPtr& message, const cv::Mat& image) {
  const ros::Time stamp = message->header.stamp;
  if (stamp < last_) segmenter_->reset();  // a recording that starts again
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

void SegmentationNode::publish_overlay(const sensor_msgs::Image& message, const cv::Mat& image,
                                       const Contour& measured) const {
  Eigen::Matrix2Xd predicted;
  if (predicted_ && predicted_->u.size() == predicted_->v.size()) {
    predicted.resize(2, static_cast<Eigen::Index>(predicted_->u.size()));
    for (Eigen::Index i = 0; i < predicted.cols(); ++i) {
      predicted.col(i) << predicted_->u[static_cast<std::size_t>(i)], predicted_->v[static_cast<std::size_t>(i)];
    }
  }
  const cv::Mat canvas = draw_overlay(image, measured, predicted);
  overlay_publisher_.publish(cv_bridge::CvImage(message.header, "bgr8", canvas).toImageMsg());
}

}  // namespace tissue_stiffness
