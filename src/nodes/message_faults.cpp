#include "nodes/message_faults.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <regex>

namespace tissue_stiffness {
namespace {

using Cloud = sensor_msgs::PointCloud2;
using Field = sensor_msgs::PointField;
using Spoil = std::function<Corruption()>;

template <typename Message>
Message deserialised(MessageBytes bytes) {
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  Message message;
  ros::serialization::deserialize(stream, message);
  return message;
}

template <typename Message>
MessageBytes serialised(const Message& message) {
  MessageBytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

std::size_t draw_index(std::size_t count, std::mt19937& random) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

double draw_not_finite(std::mt19937& random) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::array<double, 3> values{std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
  return values[draw_index(values.size(), random)];
}

Corruption without_stamp(const MessageBytes& message) {
  std_msgs::Header header = read_header(message);
  header.stamp = ros::Time();
  return {with_header(message, header), "stamp of zero"};
}

Corruption in_no_frame(const MessageBytes& message) {
  std_msgs::Header header = read_header(message);
  header.frame_id = "nowhere";
  return {with_header(message, header), "frame nowhere"};
}

Corruption cut(MessageBytes message, std::mt19937& random) {
  message.resize(draw_index(message.size(), random));
  return {message, "cut message"};
}

// Clouds and images.
template <typename Message>
Corruption with_less_data(Message message, std::mt19937& random) {
  message.data.resize(draw_index(message.data.size(), random));
  return {serialised(message), "less data"};
}

Corruption with_bad_wrench(geometry_msgs::WrenchStamped message, std::mt19937& random) {
  auto &force = message.wrench.force, &torque = message.wrench.torque;
  const std::array<double*, 6> numbers{&force.x, &force.y, &force.z, &torque.x, &torque.y, &torque.z};
  const std::size_t place = draw_index(numbers.size(), random);
  *numbers[place] = draw_not_finite(random);
  return {serialised(message), "wrench " + std::to_string(*numbers[place])};
}

std::vector<Field> coordinates(const Cloud& cloud) {
  std::vector<Field> out;
  for (const Field& field : cloud.fields) {
    const bool real = field.datatype == Field::FLOAT32 || field.datatype == Field::FLOAT64;
    const std::size_t width = field.datatype == Field::FLOAT32 ? sizeof(float) : sizeof(double);
    if (real && field.offset + width <= cloud.point_step) out.push_back(field);
  }
  return out;
}

Corruption with_bad_point(Cloud cloud, const std::vector<Field>& fields, std::mt19937& random) {
  const Field& field = fields[draw_index(fields.size(), random)];
  std::uint8_t* at =
      cloud.data.data() + draw_index(cloud.data.size() / cloud.point_step, random) * cloud.point_step + field.offset;
  const double value = draw_not_finite(random);
  if (field.datatype == Field::FLOAT32) {
    const auto narrow = static_cast<float>(value);
    std::memcpy(at, &narrow, sizeof narrow);
  } else {
    std::memcpy(at, &value, sizeof value);
  }
  return {serialised(cloud), "point " + std::to_string(value)};
}

}  // namespace

bool begins_with_header(const std::string& definition) {
  static const std::regex header("^(\\s*(#.*)?\\n)*\\s*(std_msgs/)?Header\\s+\\w+[^=\\w]", std::regex::ECMAScript);
  return std::regex_search(definition + "\n", header, std::regex_constants::match_continuous);
}

std_msgs::Header read_header(const MessageBytes& message) {
  return deserialised<std_msgs::Header>(message);
}

MessageBytes with_header(const MessageBytes& message, const std_msgs::Header& header) {
  const auto old = ros::serialization::serializationLength(read_header(message));
  MessageBytes out = serialised(header);
  out.insert(out.end(), message.begin() + static_cast<std::ptrdiff_t>(old), message.end());
  return out;
}

Corruption corrupt(const MessageBytes& message, const std::string& datatype, std::mt19937& random) {
  std::vector<Spoil> ways{[&] { return without_stamp(message); }, [&] { return in_no_frame(message); },
                          [&] { return cut(message, random); }};
  if (datatype == "geometry_msgs/WrenchStamped") {
    ways.emplace_back([&] { return with_bad_wrench(deserialised<geometry_msgs::WrenchStamped>(message), random); });
  } else if (datatype == "sensor_msgs/PointCloud2") {
    const auto cloud = deserialised<Cloud>(message);
    const std::vector<Field> fields = coordinates(cloud);
    const bool has_points = !fields.empty() && cloud.data.size() >= cloud.point_step;
    if (has_points) ways.emplace_back([=, &random] { return with_bad_point(cloud, fields, random); });
    if (!cloud.data.empty()) ways.emplace_back([=, &random] { return with_less_data(cloud, random); });
  } else if (datatype == "sensor_msgs/Image") {
    const auto image = deserialised<sensor_msgs::Image>(message);
    if (!image.data.empty()) ways.emplace_back([=, &random] { return with_less_data(image, random); });
  }
  return ways[draw_index(ways.size(), random)]();
}

}  // namespace tissue_stiffness
