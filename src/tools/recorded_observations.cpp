#include "tools/recorded_observations.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "nodes/sensor_conversions.hpp"
#include "segmentation/lens.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kPictureWidth = 480.0;  // [pixel]
constexpr int kPictureQuality = 70;      // of JPEG

}  // namespace

RecordedObservations::RecordedObservations(std::string file, const ModelSettings& settings, const RecordedPoses& poses)
    : file_(std::move(file)), settings_(settings), poses_(poses) {}

void RecordedObservations::set_mesh(const TetMesh& mesh) {
  vertex_count_ = mesh.corner_count;
  body_points_ = make_body_points(settings_, mesh);
  anchors_ = make_feature_anchors(settings_, mesh);
}

void RecordedObservations::add(const RecordedMeasurement& measurement, Instant& instant) {
  if (measurement.image) return add_image(measurement, instant);
  measurement.wrench ? add_force(measurement, instant) : add_cloud(measurement, instant);
}

void RecordedObservations::add_force(const RecordedMeasurement& measurement, Instant& instant) {
  const auto model_from_sensor = poses_.model_from(measurement.wrench->header, instant.reason);
  if (!model_from_sensor) return;
  instant.frame.observations.push_back(
      to_reaction(*measurement.wrench, measurement.source, *model_from_sensor, settings_of(measurement.source).topic));
}

void RecordedObservations::add_cloud(const RecordedMeasurement& measurement, Instant& instant) {
  const auto model_from_sensor = poses_.model_from(measurement.cloud->header, instant.reason);
  if (!model_from_sensor) return;
  Observation out = to_observation(*measurement.cloud, settings_of(measurement.source), measurement.source, vertex_count_,
                                   *model_from_sensor);
  try {
    select_body(body_points_, settings_, &out);
  } catch (const InputError& error) {
    instant.reason = error.what();
    return;
  }
  instant.frame.observations.push_back(std::move(out));
}

void RecordedObservations::add_image(const RecordedMeasurement& measurement, Instant& instant) {
  if (images_[measurement.source]++ % used_stride_ != 0) return;
  const ObservationSettings& settings = settings_of(measurement.source);
  const std_msgs::Header& header = measurement.image->header;
  const auto model_from_sensor = poses_.model_from(header, instant.reason);
  if (!model_from_sensor) return;
  auto camera = std::make_shared<Camera>(
      to_camera(*camera_info(settings.camera_info, header.stamp), settings, *model_from_sensor, settings.camera_info));
  const cv::Mat image = to_image(measurement.image, settings.segmentation.kind, settings.topic);
  require_image_size(image.size(), {camera->width, camera->height}, settings.topic, settings.camera_info);
  keep_picture(measurement, image, *camera);
  const auto start = std::chrono::steady_clock::now();
  if (settings.kind == ObservationKind::tracks) {
    track(measurement.source, image, *camera, instant);
  } else {
    segment(measurement.source, image, camera, instant);
  }
  instant.segment_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void RecordedObservations::segment(int source, const cv::Mat& image, const std::shared_ptr<Camera>& camera,
                                   Instant& instant) {
  const ObservationSettings& settings = settings_of(source);
  std::unique_ptr<Segmenter>& segmenter = segmenters_[source];
  if (!segmenter) segmenter = make_segmenter(settings.segmentation);
  Segmentation found = segmenter->segment(image, instant.frame.time);
  if (!found.found()) {
    instant.reason = settings.topic + ": " + found.reason;
    return;
  }
  undistort(*camera, &found.contour);
  Observation out;
  out.source = source;
  out.kind = ObservationKind::contour;
  out.time = instant.frame.time;
  out.contour = std::make_shared<Contour>(std::move(found.contour));
  out.camera = camera;
  instant.frame.observations.push_back(std::move(out));
}

void RecordedObservations::track(int source, const cv::Mat& image, const Camera& camera, Instant& instant) {
  const ObservationSettings& settings = settings_of(source);
  std::unique_ptr<FeatureTracker>& tracker = trackers_[source];
  if (!tracker) tracker = make_feature_tracker(settings.features);
  TrackedFeatures found = tracker->track(image, instant.frame.time);
  const auto anchors = anchors_.find(source);
  if (!found.found() || anchors == anchors_.end()) {
    instant.reason = settings.topic + ": " + (found.found() ? "no mesh yet that carries the features" : found.reason);
    return;
  }
  undistort(camera, &found.tracks);
  try {
    instant.frame.observations.push_back(anchors->second.observe(found.tracks, camera, source, settings.topic));
  } catch (const InputError& error) {
    instant.reason = error.what();
  }
}

// Undistorted, because the outlines that the report draws over it are.
void RecordedObservations::keep_picture(const RecordedMeasurement& measurement, const cv::Mat& image,
                                        const Camera& camera) {
  if (used_images_[measurement.source]++ % kept_stride_ != 0) return;
  cv::Mat small = undistort(camera, image);
  const double scale = kPictureWidth / image.cols;
  if (scale < 1.0) cv::resize(small, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", small, bytes, {cv::IMWRITE_JPEG_QUALITY, kPictureQuality});
  pictures_.push_back({measurement.source, measurement.image->header.stamp.toSec(), {bytes.begin(), bytes.end()}});
}

// Returns the message with the image's stamp. Otherwise it returns the last one before, or else the first one after it.
sensor_msgs::CameraInfoConstPtr RecordedObservations::camera_info(const std::string& topic, const ros::Time& stamp) const {
  const auto known = cameras_.find(topic);
  if (known == cameras_.end()) {
    throw InputError(file_ + ": topic " + topic, "nothing within 0.5 s of the first image", "CameraInfo with each image");
  }
  const auto after = known->second.upper_bound(stamp);
  return after == known->second.begin() ? after->second : std::prev(after)->second;
}

}  // namespace tissue_stiffness
