#include "tools/bag_reader.hpp"

#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <chrono>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "nodes/estimator_inputs.hpp"
#include "nodes/sensor_conversions.hpp"
#include "segmentation/lens.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_message.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kReorderSpan = 0.5;         // [s] a message may lag behind the newest stamp
constexpr double kPatience = 0.25;           // [s] least silence that makes a stamp believed; less than the lag
constexpr std::size_t kReorderFrames = 256;  // the same, in frames: bounds the memory
constexpr std::size_t kMostPictures = 40;    // of each sensor, in the report
constexpr double kPictureWidth = 480.0;      // [pixel]
constexpr int kPictureQuality = 70;          // of JPEG
constexpr double kPoseMemory = 60.0;         // [s] of /tf kept; more than any frame lags behind

}  // namespace

BagReader::BagReader(const std::string& file, const ModelSettings& settings, std::string model_frame)
    : file_(file),
      settings_(settings),
      model_frame_(std::move(model_frame)),
      load_inputs_(load_topics(settings)),
      poses_(ros::Duration(kPoseMemory)) {
  try {
    open();
    check_topics();
    read_static_poses();
    view_.addQuery(bag_, rosbag::TopicQuery(topics()));
    next_message_ = view_.begin();
    while (!front_is_complete() && read_message()) {
    }
  } catch (const rosbag::BagException& error) {
    throw InputError(file_, error.what(), "a bag that `rosbag check` accepts");
  }
  if (pending_.empty()) throw InputError(file_, "no message on the model's topics", "at least one frame");
}

void BagReader::set_mesh(const TetMesh& mesh) {
  vertex_count_ = mesh.corner_count;
  body_points_ = make_body_points(settings_, mesh);
  anchors_ = make_feature_anchors(settings_, mesh);
}

void BagReader::open() {
  try {
    bag_.open(file_, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(file_, "a bag without its index", "a closed bag (`rosbag reindex` repairs it)");
  } catch (const rosbag::BagIOException&) {
    throw InputError(file_, "no readable file", "a rosbag");
  } catch (const rosbag::BagException& error) {
    throw InputError(file_, error.what(), "a rosbag, version 2.0");
  }
}

void BagReader::check_topics() {
  for (const ObservationSettings& observation : settings_.observations) {
    const ObservationTraits& traits = traits_of(observation.kind);
    require_topic(observation.topic, traits.message);
    if (traits.image) require_topic(observation.camera_info, "sensor_msgs/CameraInfo");
    rosbag::View messages(bag_, rosbag::TopicQuery(observation.topic));
    frame_count_ = std::max<std::size_t>(frame_count_, messages.size());
  }
  for (const LoadInput& input : load_inputs_) require_topic(input.topic, message_type(input.kind));
}

void BagReader::require_topic(const std::string& topic, const std::string& type) {
  rosbag::View all(bag_);
  std::string fitting, found;
  for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
    if (connection->topic == topic) found = connection->datatype;
    if (connection->datatype == type) fitting += (fitting.empty() ? "" : ", ") + connection->topic;
  }
  if (found == type) return;
  const std::string there = fitting.empty() ? type + ", of which this bag has none" : type + ": " + fitting;
  throw InputError(file_ + ": topic " + topic, found.empty() ? "nothing" : found, there);
}

std::vector<std::string> BagReader::topics() const {
  std::vector<std::string> out{"/tf"};
  for (const ObservationSettings& observation : settings_.observations) {
    out.push_back(observation.topic);
    if (traits_of(observation.kind).image) out.push_back(observation.camera_info);
  }
  for (const LoadInput& input : load_inputs_) out.push_back(input.topic);
  return out;
}

// Static poses are read first, because a latched message may have been recorded after the first frames.
void BagReader::read_static_poses() {
  rosbag::View messages(bag_, rosbag::TopicQuery("/tf_static"));
  for (const rosbag::MessageInstance& message : messages) add_poses(message, true);
}

void BagReader::add_poses(const rosbag::MessageInstance& message, bool is_static) {
  const auto read = read_as<tf2_msgs::TFMessage>(message, file_);  // held: the loop would not keep it alive
  for (geometry_msgs::TransformStamped pose : read->transforms) {
    to_isometry(pose.transform, message.getTopic() + ": " + pose.child_frame_id);  // tf2 only logs what is wrong
    pose.header.frame_id = plain_frame(pose.header.frame_id);
    pose.child_frame_id = plain_frame(pose.child_frame_id);
    poses_.setTransform(pose, file_, is_static);
  }
}

bool BagReader::read_message() {
  if (next_message_ == view_.end()) {
    release_last();
    return false;
  }
  const rosbag::MessageInstance message = *next_message_++;
  now_ = message.getTime().toSec();
  release_first();
  const std::string& topic = message.getTopic();
  if (topic == "/tf") add_poses(message, false);
  for (std::size_t i = 0; i < settings_.observations.size(); ++i) {
    const ObservationSettings& observation = settings_.observations[i];
    const int source = static_cast<int>(i);
    if (topic == observation.topic && traits_of(observation.kind).image) {
      const auto image = read_as<sensor_msgs::Image>(message, file_);
      require_stamp(image->header, topic);
      add_measurement(topic, image->header.stamp, {source, nullptr, image, nullptr});
    } else if (topic == observation.topic && traits_of(observation.kind).force) {
      add_force(message, source);
    } else if (topic == observation.topic) {
      const auto cloud = read_as<sensor_msgs::PointCloud2>(message, file_);
      require_stamp(cloud->header, topic);
      add_measurement(topic, cloud->header.stamp, {source, cloud, nullptr, nullptr});
    } else if (topic == observation.camera_info) {
      const auto info = read_as<sensor_msgs::CameraInfo>(message, file_);
      cameras_[topic][info->header.stamp] = info;
    }
  }
  for (const LoadInput& input : load_inputs_) {
    if (topic == input.topic) add_load(message, input);
  }
  return true;
}

void BagReader::accept(const std::string& name, const ros::Time& stamp, Put put) {
  Filter& filter = filters_.try_emplace(name, kPatience).first->second;
  const std::size_t left_out = filter.left_out();
  believe(filter, filter.add(stamp, std::move(put), now_));
  if (filter.left_out() > left_out) last_broken_ = name + ": " + filter.last_left_out();
  release_agreeing();
}

void BagReader::believe(Filter& filter, const std::vector<Filter::Stamped>& believed) {
  for (const Filter::Stamped& message : believed) {
    filter.advance(message.stamp);
    message.message();
  }
}

// Held messages are believed where they go on from the stamps of another topic.
void BagReader::release_agreeing() {
  for (auto& [name, filter] : filters_) {
    if (!filter.holds()) continue;
    const auto agrees = [&, &own = filter](const ros::Time& stamp) {
      return std::any_of(filters_.begin(), filters_.end(), [&](const auto& other) {
        const Filter& filter = other.second;
        const bool silent = own.stamps().seen && filter.silent_from() < now_;
        return &filter != &own && filter.stamps().seen && !silent && filter.stamps().go_on_with(stamp);
      });
    };
    const std::size_t left_out = filter.left_out();
    believe(filter, filter.release_if(agrees));
    if (filter.left_out() > left_out) last_broken_ = name + ": " + filter.last_left_out();
  }
}

// Two messages cannot agree as three would, so those of such a topic are believed after a silence. So is the first message
// of all.
void BagReader::release_first() {
  const bool any_seen =
      std::any_of(filters_.begin(), filters_.end(), [](const auto& filter) { return filter.second.stamps().seen; });
  for (auto& [name, filter] : filters_) {
    if (!filter.holds() || filter.stamps().seen || filter.silent_from() > now_) continue;
    rosbag::View all(bag_, rosbag::TopicQuery(name));
    if (!any_seen || all.size() < kAgreeingStamps) believe(filter, filter.release());
  }
}

// A topic's only messages have none to be judged by; a jump at the end has none that agree.
void BagReader::release_last() {
  for (auto& [name, filter] : filters_) {
    if (!filter.holds()) continue;
    if (!filter.stamps().seen) {
      believe(filter, filter.release());
      continue;
    }
    filter.leave_out_held();
    last_broken_ = name + ": " + filter.last_left_out();
  }
}

int BagReader::broken_stamps() const {
  std::size_t out = 0;
  for (const auto& [name, filter] : filters_) out += filter.left_out();
  return static_cast<int>(out);
}

void BagReader::add_force(const rosbag::MessageInstance& message, int source) {
  const std::string& topic = message.getTopic();
  const auto wrench = read_as<geometry_msgs::WrenchStamped>(message, file_);
  require_stamp(wrench->header, topic);
  const double rate = settings_.observations[static_cast<std::size_t>(source)].rate;
  if (limits_.try_emplace(source, rate).first->second.keep(wrench->header.stamp))
    add_measurement(topic, wrench->header.stamp, {source, nullptr, nullptr, wrench});
}

void BagReader::add_measurement(const std::string& topic, const ros::Time& stamp, Measurement measurement) {
  accept(topic, stamp, [this, stamp, measurement = std::move(measurement)] {
    note_stamp(stamp);
    if (stamp <= last_returned_) {
      ++late_;
    } else {
      pending_[stamp].push_back(measurement);
    }
  });
}

void BagReader::add_load(const rosbag::MessageInstance& message, const LoadInput& input) {
  if (input.kind == LoadInput::Kind::pressure) {
    const auto pressure = read_as<sensor_msgs::FluidPressure>(message, file_);
    require_stamp(pressure->header, input.topic);
    add_load(input.topic, pressure->header.stamp, to_load(*pressure, input.topic));
    return;
  }
  input.kind == LoadInput::Kind::wrench ? add_posed_load<geometry_msgs::WrenchStamped>(message, input.topic)
                                        : add_posed_load<geometry_msgs::PoseStamped>(message, input.topic);
}

template <typename Message>
void BagReader::add_posed_load(const rosbag::MessageInstance& message, const std::string& topic) {
  const auto read = read_as<Message>(message, file_);
  require_stamp(read->header, topic);
  std::string reason;
  const auto model_from_sensor = pose(read->header, reason);
  if (!model_from_sensor) throw InputError(file_ + ": " + topic, reason, "a frame with a pose in " + model_frame_);
  add_load(topic, read->header.stamp, to_load(*read, *model_from_sensor, topic));
}

void BagReader::add_load(const std::string& topic, const ros::Time& stamp, const LoadSample& sample) {
  accept(topic, stamp, [this, stamp, sample] {
    note_stamp(stamp);
    loads_.push_back(sample);
  });
}

void BagReader::note_stamp(const ros::Time& stamp) {
  if (last_returned_.isZero()) first_stamp_ = std::min(first_stamp_, stamp);
  newest_ = std::max(newest_, stamp);
}

bool BagReader::front_is_complete() const {
  if (pending_.empty()) return false;
  return pending_.size() > kReorderFrames || seconds_between(pending_.begin()->first, newest_) > kReorderSpan;
}

std::optional<Instant> BagReader::next() {
  try {
    while (!front_is_complete() && read_message()) {
    }
  } catch (const rosbag::BagException& error) {
    throw InputError(file_, error.what(), "a bag that `rosbag check` accepts");
  }
  if (pending_.empty()) return std::nullopt;
  auto front = pending_.extract(pending_.begin());
  std::stable_sort(front.mapped().begin(), front.mapped().end(),
                   [](const Measurement& a, const Measurement& b) { return a.source < b.source; });
  last_returned_ = front.key();
  Instant instant;
  instant.frame.time = last_returned_.toSec();
  instant.loads.swap(loads_);
  for (const Measurement& measurement : front.mapped()) convert(measurement, instant);
  return instant;
}

void BagReader::convert(const Measurement& measurement, Instant& instant) {
  if (measurement.image) return observe_image(measurement, instant);
  const std_msgs::Header& header = measurement.wrench ? measurement.wrench->header : measurement.cloud->header;
  const auto model_from_sensor = pose(header, instant.reason);
  if (!model_from_sensor) return;
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(measurement.source)];
  if (measurement.wrench) {
    instant.frame.observations.push_back(
        to_reaction(*measurement.wrench, measurement.source, *model_from_sensor, settings.topic));
    return;
  }
  Observation out = to_observation(*measurement.cloud, settings, measurement.source, vertex_count_, *model_from_sensor);
  try {
    select_body(body_points_, settings_, &out);
  } catch (const InputError& error) {
    instant.reason = error.what();
    return;
  }
  instant.frame.observations.push_back(std::move(out));
}

void BagReader::observe_image(const Measurement& measurement, Instant& instant) {
  if (come_[measurement.source]++ % image_stride_ != 0) return;
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(measurement.source)];
  const std_msgs::Header& header = measurement.image->header;
  const auto model_from_sensor = pose(header, instant.reason);
  if (!model_from_sensor) return;
  auto camera = std::make_shared<Camera>(
      to_camera(*camera_info(settings.camera_info, header.stamp), settings, *model_from_sensor, settings.camera_info));
  const cv::Mat image = to_image(measurement.image, settings.segmentation.kind, settings.topic);
  if (image.cols != camera->width || image.rows != camera->height) {
    throw InputError(
        settings.topic, std::to_string(image.cols) + " x " + std::to_string(image.rows) + " pixels",
        std::to_string(camera->width) + " x " + std::to_string(camera->height) + " as in " + settings.camera_info);
  }
  keep_picture(measurement, image, *camera);
  const auto start = std::chrono::steady_clock::now();
  if (settings.kind == ObservationKind::tracks) {
    track(measurement.source, image, *camera, instant);
  } else {
    segment(measurement.source, image, camera, instant);
  }
  instant.segment_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void BagReader::segment(int source, const cv::Mat& image, const std::shared_ptr<Camera>& camera, Instant& instant) {
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(source)];
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

void BagReader::track(int source, const cv::Mat& image, const Camera& camera, Instant& instant) {
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(source)];
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
void BagReader::keep_picture(const Measurement& measurement, const cv::Mat& image, const Camera& camera) {
  const std::size_t stride = (frame_count_ + kMostPictures - 1) / kMostPictures;
  if (images_[measurement.source]++ % std::max<std::size_t>(1, stride) != 0) return;
  cv::Mat small = undistort(camera, image);
  const double scale = kPictureWidth / image.cols;
  if (scale < 1.0) cv::resize(small, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", small, bytes, {cv::IMWRITE_JPEG_QUALITY, kPictureQuality});
  pictures_.push_back({measurement.source, measurement.image->header.stamp.toSec(), {bytes.begin(), bytes.end()}});
}

std::vector<double> BagReader::picture_stamps() const {
  std::vector<double> out;
  for (const Picture& picture : pictures_) out.push_back(picture.stamp);
  return out;
}

// Returns the message with the image's stamp. Otherwise it returns the last one before, or else the first one after it.
sensor_msgs::CameraInfoConstPtr BagReader::camera_info(const std::string& topic, const ros::Time& stamp) const {
  const auto known = cameras_.find(topic);
  if (known == cameras_.end()) {
    throw InputError(file_ + ": topic " + topic, "nothing within 0.5 s of the first image", "CameraInfo with each image");
  }
  const auto after = known->second.upper_bound(stamp);
  return after == known->second.begin() ? after->second : std::prev(after)->second;
}

std::optional<Eigen::Isometry3d> BagReader::pose(const std_msgs::Header& header, std::string& reason) const {
  const std::string frame = plain_frame(header.frame_id);
  if (frame == model_frame_) return Eigen::Isometry3d::Identity();
  try {
    if (frame.empty()) throw tf2::InvalidArgumentException("the message's frame_id is empty");
    return to_isometry(poses_.lookupTransform(model_frame_, frame, header.stamp).transform, "/tf: " + frame);
  } catch (const tf2::TransformException& error) {
    reason = "no pose of frame '" + frame + "' in '" + model_frame_ + "': " + error.what();
    return std::nullopt;
  }
}

}  // namespace tissue_stiffness
