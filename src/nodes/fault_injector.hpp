#pragma once

#include <ros/node_handle.h>
#include <topic_tools/shape_shifter.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "nodes/diagnostics.hpp"
#include "nodes/faulty_topic.hpp"
#include "nodes/ros_settings.hpp"

namespace tissue_stiffness {

/// Relays topics and makes faults on the way, so that a test sees what the nodes behind it bear. Any type is relayed whose
/// messages begin with a header. `faults` tells each fault, and /diagnostics counts them.
///
/// The first messages wait until somebody listens to the output, and held ones are sent when a topic falls silent.
///
/// Private parameters: `topics` (a list of {input, output}), `seed`, and the rates and lengths of the faults (node_keys).
class FaultInjector {
 public:
  FaultInjector(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  int exit_code() const { return 0; }

 private:
  using Message = topic_tools::ShapeShifter;
  struct Relay {
    std::string input, output;
    std::uint32_t number = 0;
    ros::Subscriber subscriber;
    ros::Publisher publisher;
    std::unique_ptr<FaultyTopic> topic;  ///< null before the first message
    Message type;                        ///< a message of the topic's type
    std::deque<MessageBytes> waiting;
    ros::WallTime last;
  };

  FaultInjector(ros::NodeHandle node, const NodeSettings& settings);

  void add_relay(const std::string& input, const std::string& output);
  void on_message(Relay& relay, const Message& message);
  void begin(Relay& relay, const Message& message);
  void send(Relay& relay, const std::vector<MessageBytes>& messages);
  void send_waiting(Relay& relay);
  void look_for_silence();

  ros::NodeHandle node_;
  FaultSettings settings_;
  Diagnostics diagnostics_;
  ros::Publisher faults_;
  std::vector<std::unique_ptr<Relay>> relays_;
  ros::WallTimer timer_;
};

}  // namespace tissue_stiffness
