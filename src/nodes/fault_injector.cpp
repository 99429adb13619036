#include "nodes/fault_injector.hpp"

#include <ros/ros.h>

#include <algorithm>
#include <utility>

#include "nodes/node_keys.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::uint32_t kQueue = 10000;  // messages: a stalled process loses none
constexpr double kSilence = 1.0;         // [s] of a topic, in wall time, after which nothing is held
constexpr double kLookInterval = 0.1;    // [s]
constexpr std::size_t kMostWaiting = kQueue;

const std::vector<KeySpec>& keys() {
  return node_keys("fault_injector");
}

NodeSettings read_settings(const ros::NodeHandle& private_node) {
  return read_node_settings(private_node, names_of(keys()));
}

FaultSettings read_faults(const Value& own) {
  const auto number = [&](const std::string& name) { return read_number(own, find_key(keys(), name)); };
  FaultSettings out;
  out.seed = static_cast<std::uint32_t>(read_integer(own, find_key(keys(), "seed")));
  double sum = 0.0;
  for (const Fault fault :
       {Fault::drop, Fault::delay, Fault::duplicate, Fault::reorder, Fault::corrupt, Fault::restamp, Fault::mute}) {
    out.rates[fault] = number(to_string(fault));
    if (fault != Fault::mute) sum += out.rates[fault];
  }
  if (sum > 1.0) {
    throw InputError(own.path() + ": drop + delay + duplicate + reorder + corrupt + restamp", std::to_string(sum),
                     "at most 1: a message has one fault");
  }
  out.longest_delay = number("longest_delay");
  out.longest_shift = number("longest_shift");
  out.longest_mute = number("longest_mute");
  out.active = number("active");
  out.quiet = number("quiet");
  if (out.quiet > 0.0 && out.active == 0.0) {
    throw InputError(own.path() + ": active", "0 s", "> 0 s where `quiet` is, so that faults happen at all");
  }
  return out;
}

MessageBytes to_bytes(const topic_tools::ShapeShifter& message) {
  MessageBytes bytes(message.size());
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(stream);
  return bytes;
}

}  // namespace

FaultInjector::FaultInjector(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : FaultInjector(node, read_settings(private_node)) {}

FaultInjector::FaultInjector(ros::NodeHandle node, const NodeSettings& settings)
    : node_(std::move(node)),
      settings_(read_faults(settings.own)),
      diagnostics_(node_, "faults", read_number(settings.own, find_key(keys(), "diagnostic_period"))),
      faults_(node_.advertise<InjectedFault>("faults", kQueue)) {
  settings.model.require_all_read();  // there is none
  const std::vector<Value>& topics = settings.own.at("topics").items();
  if (topics.empty()) throw InputError(settings.own.at("topics").path(), "[]", "a list of {input, output}");
  for (const Value& topic : topics) {
    add_relay(topic.at("input").as_text(), topic.at("output").as_text());
    topic.require_all_read();
  }
  diagnostics_.state(DiagnosticStatus::OK, "relaying");
  timer_ =
      node_.createWallTimer(ros::WallDuration(kLookInterval), [this](const ros::WallTimerEvent&) { look_for_silence(); });
}

void FaultInjector::add_relay(const std::string& input, const std::string& output) {
  auto relay = std::make_unique<Relay>();
  relay->input = input;
  relay->output = output;
  relay->number = static_cast<std::uint32_t>(relays_.size());
  const boost::function<void(const Message::ConstPtr&)> callback =
      [this, to = relay.get()](const Message::ConstPtr& message) { on_message(*to, *message); };
  relay->subscriber = node_.subscribe<Message>(input, kQueue, callback);
  relays_.push_back(std::move(relay));
}

void FaultInjector::on_message(Relay& relay, const Message& message) {
  relay.last = ros::WallTime::now();
  try {
    if (!relay.topic) begin(relay, message);
    FaultyTopic::Passed passed = relay.topic->pass(to_bytes(message));
    diagnostics_.count("messages of " + relay.output);
    if (passed.fault) {
      passed.fault->topic = relay.output;
      faults_.publish(*passed.fault);
      diagnostics_.count(passed.fault->fault);
    }
    send(relay, passed.messages);
  } catch (const std::exception& error) {
    diagnostics_.bad_message(relay.input + ": " + error.what());
  }
}

void FaultInjector::begin(Relay& relay, const Message& message) {
  if (!begins_with_header(message.getMessageDefinition())) {
    throw InputError("type", message.getDataType(), "messages that begin with a std_msgs/Header");
  }
  relay.type = message;
  relay.publisher = message.advertise(node_, relay.output, kQueue);
  relay.topic = std::make_unique<FaultyTopic>(settings_, message.getDataType(), relay.number);
}

void FaultInjector::send(Relay& relay, const std::vector<MessageBytes>& messages) {
  relay.waiting.insert(relay.waiting.end(), messages.begin(), messages.end());
  send_waiting(relay);
}

void FaultInjector::send_waiting(Relay& relay) {
  if (relay.publisher.getNumSubscribers() == 0) {
    while (relay.waiting.size() > kMostWaiting) relay.waiting.pop_front();
    return;
  }
  for (; !relay.waiting.empty(); relay.waiting.pop_front()) {
    MessageBytes& bytes = relay.waiting.front();
    ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    Message message = relay.type;
    message.read(stream);
    relay.publisher.publish(message);
  }
}

void FaultInjector::look_for_silence() {
  for (const auto& relay : relays_) {
    if (!relay->topic) continue;
    if ((ros::WallTime::now() - relay->last).toSec() > kSilence) send(*relay, relay->topic->release());
    send_waiting(*relay);
  }
}

}  // namespace tissue_stiffness
