#include "nodes/setup_watch.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/ros.h>

#include <algorithm>

#include "check/check_first_frame.hpp"
#include "check/check_mesh.hpp"
#include "check/check_numbers.hpp"
#include "check/check_topics.hpp"

namespace tissue_stiffness {
namespace {

const ros::WallDuration kPeriod(5.0);

/// Returns the topics of the model with their resolved names. Images reach the estimator as contours from the segmentation.
std::vector<NeededTopic> needed_by(const ros::NodeHandle& node, const ModelSettings& settings) {
  std::vector<NeededTopic> needed = needed_topics(settings);
  for (NeededTopic& need : needed) need.topic.name = node.resolveName(need.topic.name);
  return needed;
}

/// Returns the topics of other nodes, because the estimator does not use what it publishes.
std::vector<Topic> published_topics() {
  ros::master::V_TopicInfo infos;
  if (!ros::master::getTopics(infos)) return {};
  ros::V_string own;
  ros::this_node::getAdvertisedTopics(own);
  std::vector<Topic> topics;
  for (const ros::master::TopicInfo& info : infos) {
    if (std::find(own.begin(), own.end(), info.name) == own.end()) topics.push_back({info.name, info.datatype});
  }
  return topics;
}

}  // namespace

void warn_of(const SetupFindings& findings) {
  for (const SetupFinding& finding : findings) ROS_WARN("%s", finding.sentence.c_str());
}

SetupWatch::SetupWatch(ros::NodeHandle node, const ModelSettings& settings, Diagnostics& diagnostics)
    : node_(std::move(node)), settings_(settings), diagnostics_(diagnostics) {
  say(check_numbers(settings_));
  timer_ = node_.createWallTimer(kPeriod, [this](const ros::WallTimerEvent&) { watch_topics(); });
}

void SetupWatch::mesh_came(const TetMesh& mesh) {
  const Eigen::Vector3d extent = mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff();
  say(check_extent(settings_.mesh, extent, 0.0));
}

void SetupWatch::frame_used(const Frame& frame, const TetMesh& mesh, double rest_time) {
  if (!frame_seen_.exchange(true)) say(check_first_frame(settings_, mesh, {rest_time, frame}));
}

void SetupWatch::watch_topics() {
  if (frame_seen_) return;
  const std::vector<Topic> there = published_topics();
  if (there.empty()) return;  // no master
  const SetupFindings findings = check_topics(needed_by(node_, settings_), there, "no node publishes");
  say(findings);
  const std::string left_out = diagnostics_.text("last bad message");
  if (frame_seen_) return;
  if (!findings.empty()) {
    diagnostics_.state(diagnostic_msgs::DiagnosticStatus::WARN, "no data: " + findings.front().sentence);
  } else if (!left_out.empty()) {
    diagnostics_.state(diagnostic_msgs::DiagnosticStatus::WARN, "no usable data: " + left_out);
  }
}

void SetupWatch::say(const SetupFindings& findings) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const SetupFinding& finding : findings) {
    if (!said_.insert(finding.sentence).second) continue;
    ROS_WARN("%s", finding.sentence.c_str());
  }
  std::string all;
  for (const std::string& sentence : said_) all += (all.empty() ? "" : " ") + sentence;
  if (!all.empty()) diagnostics_.set("set-up", all);
}

}  // namespace tissue_stiffness
