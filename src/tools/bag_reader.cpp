#include "tools/bag_reader.hpp"

#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <utility>

#include "nodes/estimator_inputs.hpp"
#include "nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_message.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kReorderSpan = 0.5;         // [s] a message may lag behind the newest stamp
constexpr std::size_t kReorderFrames = 256;  // the same, in frames: bounds the memory
constexpr std::size_t kMostPictures = 40;    // of each sensor, in the report

}  // namespace

BagReader::BagReader(const std::string& file, const ModelSettings& settings, std::string model_frame)
    : file_(file),
      settings_(settings),
      load_inputs_(load_topics(settings)),
      poses_(std::move(model_frame)),
      observations_(file, settings_, poses_),
      stamps_([this](const std::string& topic) { return rosbag::View(bag_, rosbag::TopicQuery(topic)).size(); }) {
  try {
    open();
    check_topics();
    thin_images(frame_count_);
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

void BagReader::thin_images(std::size_t most) {
  const auto stride = [this](std::size_t count) { return std::max<std::size_t>(1, (frame_count_ + count - 1) / count); };
  observations_.thin_images(stride(most), stride(kMostPictures));
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
  poses_.add(*read_as<tf2_msgs::TFMessage>(message, file_), message.getTopic(), is_static);
}

bool BagReader::read_message() {
  if (next_message_ == view_.end()) {
    stamps_.finish();
    return false;
  }
  const rosbag::MessageInstance message = *next_message_++;
  stamps_.advance(message.getTime().toSec());
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
      observations_.add_camera_info(topic, read_as<sensor_msgs::CameraInfo>(message, file_));
    }
  }
  for (const LoadInput& input : load_inputs_) {
    if (topic == input.topic) add_load(message, input);
  }
  return true;
}

void BagReader::add_force(const rosbag::MessageInstance& message, int source) {
  const std::string& topic = message.getTopic();
  const auto wrench = read_as<geometry_msgs::WrenchStamped>(message, file_);
  require_stamp(wrench->header, topic);
  const double rate = settings_.observations[static_cast<std::size_t>(source)].rate;
  if (limits_.try_emplace(source, rate).first->second.keep(wrench->header.stamp))
    add_measurement(topic, wrench->header.stamp, {source, nullptr, nullptr, wrench});
}

void BagReader::add_measurement(const std::string& topic, const ros::Time& stamp, RecordedMeasurement measurement) {
  stamps_.accept(topic, stamp, [this, stamp, measurement = std::move(measurement)] {
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
  const auto model_from_sensor = poses_.model_from(read->header, reason);
  if (!model_from_sensor) throw InputError(file_ + ": " + topic, reason, "a frame with a pose in " + poses_.model_frame());
  add_load(topic, read->header.stamp, to_load(*read, *model_from_sensor, topic));
}

void BagReader::add_load(const std::string& topic, const ros::Time& stamp, const LoadSample& sample) {
  stamps_.accept(topic, stamp, [this, stamp, sample] {
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
                   [](const RecordedMeasurement& a, const RecordedMeasurement& b) { return a.source < b.source; });
  last_returned_ = front.key();
  Instant instant;
  instant.frame.time = last_returned_.toSec();
  instant.loads.swap(loads_);
  for (const RecordedMeasurement& measurement : front.mapped()) observations_.add(measurement, instant);
  return instant;
}

std::vector<double> BagReader::picture_stamps() const {
  std::vector<double> out;
  for (const Picture& picture : pictures()) out.push_back(picture.stamp);
  return out;
}

}  // namespace tissue_stiffness
