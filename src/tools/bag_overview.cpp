#include "tools/bag_overview.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_message.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kImages = 5;

void open(rosbag::Bag& bag, const std::string& file) {
  try {
    bag.open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(file, "a bag without its index", "a closed bag (`rosbag reindex` repairs it)");
  } catch (const rosbag::BagException&) {
    throw InputError(file, "no readable bag", "a rosbag, version 2.0");
  }
}

template <typename Message>
bool add_header(const rosbag::MessageInstance& message, const std::string& file, TopicTimes& times, BagOverview& out) {
  if (!message.isType<Message>()) return false;
  const auto read = read_as<Message>(message, file);
  times.stamps.push_back(read->header.stamp.toSec());
  times.arrivals.push_back(message.getTime().toSec());
  out.frames.emplace(times.topic, plain_frame(read->header.frame_id));
  return true;
}

void add_times(const rosbag::MessageInstance& message, const std::string& file, BagOverview& out) {
  const auto same = [&](const TopicTimes& times) { return times.topic == message.getTopic(); };
  const auto times = std::find_if(out.times.begin(), out.times.end(), same);
  add_header<sensor_msgs::PointCloud2>(message, file, *times, out) ||
      add_header<sensor_msgs::Image>(message, file, *times, out) ||
      add_header<geometry_msgs::WrenchStamped>(message, file, *times, out) ||
      add_header<geometry_msgs::PoseStamped>(message, file, *times, out) ||
      add_header<sensor_msgs::FluidPressure>(message, file, *times, out);
}

void add_transforms(const rosbag::MessageInstance& message, const std::string& file, BagOverview& out) {
  if (!message.isType<tf2_msgs::TFMessage>()) return;
  const auto read = read_as<tf2_msgs::TFMessage>(message, file);
  for (const geometry_msgs::TransformStamped& pose : read->transforms) {
    const std::pair<std::string, std::string> joint{plain_frame(pose.header.frame_id), plain_frame(pose.child_frame_id)};
    const auto known = std::find(out.transforms.begin(), out.transforms.end(), joint);
    if (known == out.transforms.end()) out.transforms.push_back(joint);
  }
}

/// Reads all topics in one pass, because a compressed bag is slow to read.
void read(const rosbag::Bag& bag, const std::string& file, const std::vector<std::string>& topics, BagOverview& out) {
  std::map<std::string, std::size_t> strides, come;
  for (const std::string& topic : topics) {
    strides[topic] = std::max<std::size_t>(1, rosbag::View(bag, rosbag::TopicQuery(topic)).size() / kImages);
  }
  rosbag::View messages(bag, rosbag::TopicQuery(topics));
  for (const rosbag::MessageInstance& message : messages) {
    const std::string& topic = message.getTopic();
    if (topic == "/tf" || topic == "/tf_static") {
      add_transforms(message, file, out);
      continue;
    }
    add_times(message, file, out);
    if (come[topic]++ % strides[topic] != 0 || message.getDataType() != "sensor_msgs/Image") continue;
    if (out.images[topic].size() >= kImages) continue;
    out.images[topic].push_back(to_image(read_as<sensor_msgs::Image>(message, file), topic).clone());
  }
}

}  // namespace

BagOverview overview(const std::string& file, const std::vector<NeededTopic>& needed) {
  rosbag::Bag bag;
  open(bag, file);
  BagOverview out;
  try {
    rosbag::View all(bag);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      const auto known = std::find_if(out.topics.begin(), out.topics.end(),
                                      [&](const Topic& topic) { return topic.name == connection->topic; });
      if (known == out.topics.end()) out.topics.push_back({connection->topic, connection->datatype});
    }
    std::vector<std::string> topics{"/tf", "/tf_static"};
    for (const NeededTopic& need : needed) {
      if (need.topic.type == "sensor_msgs/CameraInfo") continue;
      topics.push_back(need.topic.name);
      out.times.push_back({need.topic.name, {}, {}});  // in the model file's order, observations first
    }
    read(bag, file, topics, out);
    const auto silent = [](const TopicTimes& times) { return times.stamps.empty(); };
    out.times.erase(std::remove_if(out.times.begin(), out.times.end(), silent), out.times.end());
  } catch (const rosbag::BagException& error) {
    throw InputError(file, error.what(), "a bag that `rosbag check` accepts");
  }
  return out;
}

}  // namespace tissue_stiffness
