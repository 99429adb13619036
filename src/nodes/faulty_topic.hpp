#pragma once

#include <tissue_stiffness/InjectedFault.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nodes/fault_schedule.hpp"
#include "nodes/message_faults.hpp"

namespace tissue_stiffness {

/// Passes the messages of one topic on, with faults. A delayed message waits until a message with a stamp that is later by
/// the delay has passed. A reordered one waits for the next message. A mute ends with a stamp too.
class FaultyTopic {
 public:
  /// `number`: of the topic among those of one seed.
  FaultyTopic(const FaultSettings& settings, std::string datatype, std::uint32_t number);

  struct Passed {
    std::vector<MessageBytes> messages;
    std::optional<InjectedFault> fault;  ///< its topic is left empty
  };

  /// Returns what is to be sent now that this message has come. Throws ros::Exception for a message without a header.
  Passed pass(const MessageBytes& message);

  /// Returns all messages that wait.
  std::vector<MessageBytes> release();

 private:
  struct Held {
    MessageBytes message;
    ros::Time until;  ///< of zero: the next message
  };
  bool is_mute(const ros::Time& stamp) const { return stamp >= mute_from_ && stamp < mute_until_; }
  std::vector<MessageBytes> release_due(const ros::Time& stamp);
  void apply(Fault fault, const MessageBytes& message, const std_msgs::Header& header, Passed& passed);

  FaultSchedule schedule_;
  std::string datatype_;
  std::uint64_t count_ = 0;
  std::vector<Held> held_;
  ros::Time last_, mute_from_, mute_until_;
};

}  // namespace tissue_stiffness
