#include "nodes/diagnostics.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <cstdio>
#include <utility>

namespace tissue_stiffness {
namespace {

diagnostic_msgs::KeyValue entry(const std::string& key, const std::string& value) {
  diagnostic_msgs::KeyValue out;
  out.key = key;
  out.value = value;
  return out;
}

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle node, const std::string& name) {
  status_.name = ros::this_node::getName() + ": " + name;
  status_.hardware_id = "none";
  status_.message = "starting";
  publisher_ = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  timer_ = node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publish(); });
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
  status_.level = level;
  status_.message = message;
}

void Diagnostics::expect(const std::string& topic, double longest) {
  const std::lock_guard<std::mutex> lock(mutex_);
  inputs_[topic] = {longest, ros::WallTime::now(), false};
}

void Diagnostics::heard(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Input& input = inputs_.at(topic);
  input.last = ros::WallTime::now();
  input.heard = true;
}

void Diagnostics::add_inputs(diagnostic_msgs::DiagnosticStatus& status) const {
  for (const auto& [topic, input] : inputs_) {
    const double age = (ros::WallTime::now() - input.last).toSec();
    char text[64];
    std::snprintf(text, sizeof text, input.heard ? "%.1f" : "nothing for %.1f", age);
    status.values.push_back(entry("age of " + topic + " [s]", text));
    if (!(age > input.longest) || status.level > diagnostic_msgs::DiagnosticStatus::WARN) continue;
    std::snprintf(text, sizeof text, " for %.0f s", age);
    status.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status.message += "; no message on " + topic + text;
  }
}

void Diagnostics::bad_message(const std::string& what) {
  ROS_WARN_STREAM_THROTTLE(1.0, "left out: " << what);
  count("bad messages");
  set("last bad message", what);
}

void Diagnostics::publish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  diagnostic_msgs::DiagnosticStatus status = status_;
  add_inputs(status);
  for (const auto& [key, count] : counts_) status.values.push_back(entry(key, std::to_string(count)));
  for (const auto& [key, text] : texts_) status.values.push_back(entry(key, text));
  for (const auto& [name, stage] : stages_) {
    char text[64];
    std::snprintf(text, sizeof text, "%.3f mean, %.3f longest", 1e3 * stage.sum / stage.runs, 1e3 * stage.longest);
    status.values.push_back(entry(name + " [ms]", text));
  }
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(std::move(status));
  publisher_.publish(array);
}

}  // namespace tissue_stiffness
