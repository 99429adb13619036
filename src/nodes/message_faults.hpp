#pragma once

#include <std_msgs/Header.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A serialised message.
using MessageBytes = std::vector<std::uint8_t>;

/// Returns whether messages of this definition begin with a header.
bool begins_with_header(const std::string& definition);

// These functions read and replace the header that a message begins with. They throw ros::Exception for a message that is
// too short.
std_msgs::Header read_header(const MessageBytes& message);
MessageBytes with_header(const MessageBytes& message, const std_msgs::Header& header);

/// A spoilt message, and what is wrong with it.
struct Corruption {
  MessageBytes message;
  std::string detail;
};

/// Spoils a message of this type in one of several ways. Any message may lose its stamp, its frame or its end. Clouds and
/// wrenches may get a number that is not finite. Clouds and images may get less data than they claim to have.
Corruption corrupt(const MessageBytes& message, const std::string& datatype, std::mt19937& random);

}  // namespace tissue_stiffness
