#include "tissue_stiffness/tools/bag_overview.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "tissue_stiffness/nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kImages = 5;

std::string plain(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

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
bool add_header(const rosbag::MessageInstance& message, TopicTimes& times, BagOverview& out) {
  const auto read = message.instantiate<Message>();
  if (!read) return false;
  times.stamps.push_back(read->header.stamp.toSec());
  times.arrivals.push_back(message.getTime().toSec());
  out.frames.emplace(times.topic, plain(read->header.frame_id));
  return true;
}

void read_times(const rosbag::Bag& bag, const std::string& topic, BagOverview& out) {
  TopicTimes times{topic, {}, {}};
  rosbag::View messages(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& message : messages) {
    add_header<sensor_msgs::PointCloud2>(message, times, out) || add_header<sensor_msgs::Image>(message, times, out) ||
        add_header<geometry_msgs::WrenchStamped>(message, times, out) ||
        add_header<sensor_msgs::FluidPressure>(message, times, out);
  }
  if (!times.stamps.empty()) out.times.push_back(std::move(times));
}

void read_images(const rosbag::Bag& bag, const std::string& topic, BagOverview& out) {
  rosbag::View messages(bag, rosbag::TopicQuery(topic));
  const std::size_t stride = std::max<std::size_t>(1, messages.size() / kImages);
  std::size_t index = 0;
  for (const rosbag::MessageInstance& message : messages) {
    if (index++ % stride != 0 || out.images[topic].size() == kImages) continue;
    if (const auto image = message.instantiate<sensor_msgs::Image>()) {
      out.images[topic].push_back(to_image(image, topic).clone());
    }
  }
}

void read_transforms(const rosbag::Bag& bag, BagOverview& out) {
  rosbag::View messages(bag, rosbag::TopicQuery(std::vector<std::string>{"/tf", "/tf_static"}));
  for (const rosbag::MessageInstance& message : messages) {
    const auto read = message.instantiate<tf2_msgs::TFMessage>();
    if (!read) continue;
    for (const geometry_msgs::TransformStamped& pose : read->transforms) {
      const std::pair<std::string, std::string> joint{plain(pose.header.frame_id), plain(pose.child_frame_id)};
      const auto known = std::find(out.transforms.begin(), out.transforms.end(), joint);
      if (known == out.transforms.end()) out.transforms.push_back(joint);
    }
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
    for (const NeededTopic& need : needed) {
      if (need.topic.type != "sensor_msgs/CameraInfo") read_times(bag, need.topic.name, out);
      if (need.topic.type == "sensor_msgs/Image") read_images(bag, need.topic.name, out);
    }
    read_transforms(bag, out);
  } catch (const rosbag::BagException& error) {
    throw InputError(file, error.what(), "a bag that `rosbag check` accepts");
  }
  return out;
}

}  // namespace tissue_stiffness
