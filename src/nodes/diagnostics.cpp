#include "nodes/diagnostics.hpp"

#include <ros/ros.h>

#include <algorithm>

#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

// The updater reads a period again and again, and throws for one that it cannot add to the time. The node reads and checks
// its own, so the updater looks where there is none.
constexpr const char* kNoParameters = "~diagnostic_updater";
constexpr std::uint32_t kQueue = 10;  // messages; the updater's one would be shared by all nodelets of a process

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle node, const std::string& name, double period)
    : topic_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", kQueue)),
      updater_(node, ros::NodeHandle(kNoParameters), "/" + ros::this_node::getName()) {  // it drops the first character
  updater_.setHardwareID("none");
  updater_.add(name, [this](Status& status) { fill(status); });
  timer_ = node.createWallTimer(ros::WallDuration(period), [this](const ros::WallTimerEvent&) { publish(); });
}

void Diagnostics::count(const std::string& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_[key];
}

void Diagnostics::set(const std::string& key, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  texts_[key] = text;
}

std::string Diagnostics::text(const std::string& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = texts_.find(key);
  return found == texts_.end() ? "" : found->second;
}

void Diagnostics::time(const std::string& stage, double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Stage& entry = stages_[stage];
  entry.sum += seconds;
  entry.longest = std::max(entry.longest, seconds);
  ++entry.runs;
}

void Diagnostics::state(std::uint8_t level, const std::string& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  level_ = level;
  message_ = message;
}

void Diagnostics::expect(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  inputs_[topic] = {ros::WallTime::now(), false};
}

void Diagnostics::set_longest_silence(double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  longest_silence_ = seconds;
}

void Diagnostics::heard(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Input& input = inputs_.at(topic);
  input.last = ros::WallTime::now();
  input.heard = true;
}

void Diagnostics::add_inputs(Status& status) const {
  for (const auto& [topic, input] : inputs_) {
    const double age = (ros::WallTime::now() - input.last).toSec();
    status.addf("age of " + topic + " [s]", input.heard ? "%.1f" : "nothing for %.1f", age);
    if (!(age > longest_silence_) || status.level > Status::WARN) continue;
    status.summary(Status::WARN, status.message + "; no message on " + topic + formatted(" for %.0f s", age));
  }
}

void Diagnostics::bad_message(const std::string& what) {
  ROS_WARN_STREAM_THROTTLE(1.0, "left out: " << what);
  count("bad messages");
  set("last bad message", what);
}

// update() would wait for simulated time. A clock at the end of what ros::Time can hold makes the updater throw.
void Diagnostics::publish() {
  try {
    updater_.force_update();
  } catch (const std::exception& error) {
    ROS_WARN_STREAM_THROTTLE(1.0, "nothing on /diagnostics: " << error.what());
  }
}

void Diagnostics::fill(Status& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status.summary(level_, message_);
  add_inputs(status);
  for (const auto& [key, count] : counts_) status.add(key, count);
  for (const auto& [key, text] : texts_) status.add(key, text);
  for (const auto& [name, stage] : stages_) {
    status.addf(name + " [ms]", "%.3f mean, %.3f longest", 1e3 * stage.sum / stage.runs, 1e3 * stage.longest);
  }
}

}  // namespace tissue_stiffness
