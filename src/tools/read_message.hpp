#pragma once

#include <ros/message_traits.h>
#include <rosbag/message_instance.h>

#include <string>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// Returns a bag's message. Throws InputError naming file and topic when its content does not fit its type, or when it is
/// of another version.
template <typename Message>
boost::shared_ptr<const Message> read_as(const rosbag::MessageInstance& message, const std::string& file) {
  boost::shared_ptr<const Message> read;
  try {
    read = message.instantiate<Message>();
  } catch (const rosbag::BagException&) {
    throw;
  } catch (const std::exception& error) {  // its content does not fit its type
    throw InputError(file + ": topic " + message.getTopic(), std::string("a broken message (") + error.what() + ")",
                     std::string("a whole ") + ros::message_traits::datatype<Message>());
  }
  if (read) return read;
  throw InputError(file + ": topic " + message.getTopic(), message.getDataType() + " of another version",
                   std::string(ros::message_traits::datatype<Message>()) + " " + ros::message_traits::md5sum<Message>());
}

}  // namespace tissue_stiffness
