#include "nodes/faulty_topic.hpp"

#include <algorithm>
#include <utility>

#include "nodes/topic_stamps.hpp"

namespace tissue_stiffness {
namespace {

// A stamp neither overflows nor becomes zero, which has a meaning of its own.
ros::Time shifted(const ros::Time& stamp, double seconds) {
  constexpr double kFirst = 1.0, kLast = 4.2e9;  // [s]
  return ros::Time(std::clamp(stamp.toSec() + seconds, kFirst, kLast));
}

}  // namespace

FaultyTopic::FaultyTopic(const FaultSettings& settings, std::string datatype, std::uint32_t number)
    : schedule_(settings, number), datatype_(std::move(datatype)) {}

FaultyTopic::Passed FaultyTopic::pass(const MessageBytes& message) {
  const std_msgs::Header header = read_header(message);
  const Fault fault = schedule_.next(header.stamp);
  std::vector<MessageBytes> due = release_due(header.stamp);
  last_ = header.stamp;
  Passed passed;
  if (!is_mute(header.stamp)) apply(fault, message, header, passed);
  passed.messages.insert(passed.messages.end(), due.begin(), due.end());
  ++count_;
  return passed;
}

std::vector<MessageBytes> FaultyTopic::release() {
  std::vector<MessageBytes> out;
  for (Held& held : std::exchange(held_, {})) out.push_back(std::move(held.message));
  return out;
}

std::vector<MessageBytes> FaultyTopic::release_due(const ros::Time& stamp) {
  if (goes_back(last_, stamp)) return release();  // a recording that begins again
  std::vector<MessageBytes> out;
  for (auto held = held_.begin(); held != held_.end();) {
    if (held->until > stamp) {
      ++held;
      continue;
    }
    out.push_back(std::move(held->message));
    held = held_.erase(held);
  }
  return out;
}

void FaultyTopic::apply(Fault fault, const MessageBytes& message, const std_msgs::Header& header, Passed& passed) {
  InjectedFault injected;
  switch (fault) {
    case Fault::none:
      passed.messages = {message};
      return;
    case Fault::drop:
      break;
    case Fault::delay:
      injected.seconds = schedule_.draw_delay();
      held_.push_back({message, shifted(header.stamp, injected.seconds)});
      break;
    case Fault::duplicate:
      passed.messages = {message, message};
      break;
    case Fault::reorder:
      held_.push_back({message, ros::Time()});
      break;
    case Fault::corrupt: {
      Corruption spoilt = corrupt(message, datatype_, schedule_.random());
      passed.messages = {std::move(spoilt.message)};
      injected.detail = spoilt.detail;
      break;
    }
    case Fault::restamp: {
      std_msgs::Header wrong = header;
      wrong.stamp = shifted(header.stamp, schedule_.draw_shift());
      injected.seconds = seconds_between(header.stamp, wrong.stamp);
      passed.messages = {with_header(message, wrong)};
      break;
    }
    case Fault::mute:
      injected.seconds = schedule_.draw_mute();
      mute_from_ = header.stamp;
      mute_until_ = shifted(header.stamp, injected.seconds);
      break;
  }
  injected.header.stamp = header.stamp;
  injected.fault = to_string(fault);
  injected.number = count_;
  passed.fault = std::move(injected);
}

}  // namespace tissue_stiffness
