#include "nodes/message_faults.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>

#include <boost/make_shared.hpp>
#include <map>
#include <set>

#include "cloud.hpp"
#include "nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kDraws = 200;

template <typename Message>
MessageBytes to_bytes(const Message& message) {
  MessageBytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
Message from_bytes(MessageBytes bytes) {
  Message message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  return message;
}

geometry_msgs::WrenchStamped wrench() {
  geometry_msgs::WrenchStamped out;
  out.header.stamp = ros::Time(10.5);
  out.header.frame_id = "tool";
  out.wrench.force.z = -2.0;
  return out;
}

// Draws many corruptions of a message and hands each to `check`. Returns the first words of their details.
template <typename Message, typename Check>
std::set<std::string> draw(const Message& message, Check check) {
  std::mt19937 random(1);
  std::set<std::string> seen;
  for (int k = 0; k < kDraws; ++k) {
    const Corruption spoilt = corrupt(to_bytes(message), ros::message_traits::datatype<Message>(), random);
    const std::string word = spoilt.detail.substr(0, spoilt.detail.find(' '));
    seen.insert(word);
    if (word == "cut") {
      EXPECT_THROW(from_bytes<Message>(spoilt.message), ros::Exception);
    } else {
      SCOPED_TRACE(spoilt.detail);
      check(word, from_bytes<Message>(spoilt.message));
    }
  }
  return seen;
}

// What any message may lose.
void expect_no_good_header(const std::string& word, const std_msgs::Header& header) {
  if (word == "stamp") {
    EXPECT_TRUE(header.stamp.isZero());
  }
  if (word == "frame") {
    EXPECT_EQ(header.frame_id, "nowhere");
  }
}

TEST(MessageFaults, AHeaderComesFirst) {
  using ros::message_traits::definition;
  EXPECT_TRUE(begins_with_header(definition<sensor_msgs::PointCloud2>()));
  EXPECT_TRUE(begins_with_header(definition<geometry_msgs::WrenchStamped>()));
  EXPECT_TRUE(begins_with_header(definition<sensor_msgs::Image>()));
  EXPECT_TRUE(begins_with_header("std_msgs/Header header"));
  EXPECT_FALSE(begins_with_header(definition<geometry_msgs::Wrench>()));
  EXPECT_FALSE(begins_with_header("float64 x\nHeader header\n"));
  EXPECT_FALSE(begins_with_header(""));
}

TEST(MessageFaults, ANewHeaderLeavesTheRestAsItIs) {
  const MessageBytes before = to_bytes(wrench());
  std_msgs::Header header = read_header(before);
  EXPECT_EQ(header, wrench().header);
  header.stamp = ros::Time(3610.5);
  header.frame_id = "another frame";
  const auto after = from_bytes<geometry_msgs::WrenchStamped>(with_header(before, header));
  EXPECT_EQ(after.header, header);
  EXPECT_EQ(after.wrench, wrench().wrench);
}

TEST(MessageFaults, AMessageWithoutAHeaderThrows) {
  EXPECT_THROW(read_header({1, 2, 3}), ros::Exception);
}

TEST(MessageFaults, EachCorruptionOfAWrenchIsRefused) {
  const auto seen = draw(wrench(), [](const std::string& word, const geometry_msgs::WrenchStamped& message) {
    expect_no_good_header(word, message.header);
    if (word == "wrench") {
      EXPECT_THROW(to_load(message, Eigen::Isometry3d::Identity(), "/tool/wrench"), InputError);
    }
  });
  EXPECT_EQ(seen, (std::set<std::string>{"cut", "frame", "stamp", "wrench"}));
}

TEST(MessageFaults, EachCorruptionOfACloudIsRefused) {
  ObservationSettings settings;
  settings.kind = ObservationSettings::Kind::vertices;
  settings.topic = "/tissue/vertices";
  const auto read = [&](const sensor_msgs::PointCloud2& cloud) {
    return to_observation(cloud, settings, 0, 10, Eigen::Isometry3d::Identity());
  };
  const sensor_msgs::PointCloud2 good = make_cloud({{1, 2, 3}, {4, 5, 6}}, "vertex", {3, 7});
  ASSERT_NO_THROW(read(good));
  const auto seen = draw(good, [&](const std::string& word, const sensor_msgs::PointCloud2& cloud) {
    expect_no_good_header(word, cloud.header);
    if (word == "point" || word == "less") {
      EXPECT_THROW(read(cloud), InputError);
    }
  });
  EXPECT_EQ(seen, (std::set<std::string>{"cut", "frame", "less", "point", "stamp"}));
}

TEST(MessageFaults, EachCorruptionOfAnImageIsRefused) {
  sensor_msgs::Image good;
  good.header.stamp = ros::Time(1.0);
  good.encoding = "mono8";
  good.width = good.step = 4;
  good.height = 3;
  good.data.assign(12, 100);
  const auto read = [](const sensor_msgs::Image& image) {
    return to_image(boost::make_shared<sensor_msgs::Image>(image), "/camera/image_raw");
  };
  ASSERT_NO_THROW(read(good));
  const auto seen = draw(good, [&](const std::string& word, const sensor_msgs::Image& image) {
    expect_no_good_header(word, image.header);
    if (word == "less") {
      EXPECT_THROW(read(image), InputError);
    }
  });
  EXPECT_EQ(seen, (std::set<std::string>{"cut", "frame", "less", "stamp"}));
}

TEST(MessageFaults, AnyOtherTypeLosesItsHeaderOrItsEnd) {
  sensor_msgs::FluidPressure pressure;
  pressure.header.stamp = ros::Time(1.0);
  const auto seen = draw(pressure, [](const std::string& word, const sensor_msgs::FluidPressure& message) {
    expect_no_good_header(word, message.header);
  });
  EXPECT_EQ(seen, (std::set<std::string>{"cut", "frame", "stamp"}));
}

TEST(MessageFaults, AnEmptyCloudHasNoPointToSpoil) {
  const auto seen = draw(sensor_msgs::PointCloud2(), [](const std::string&, const sensor_msgs::PointCloud2&) {});
  EXPECT_EQ(seen, (std::set<std::string>{"cut", "frame", "stamp"}));
}

}  // namespace
}  // namespace tissue_stiffness
