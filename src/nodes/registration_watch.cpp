#include "nodes/registration_watch.hpp"

#include <ros/master.h>
#include <ros/ros.h>

namespace tissue_stiffness {
namespace {

constexpr double kPeriod = 5.0;  // [s]

}  // namespace

RegistrationWatch::RegistrationWatch(ros::NodeHandle node)
    : timer_(node.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { check(); })) {}

// One answer is not enough, because a node registers one topic after the other.
void RegistrationWatch::check() {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = request[1] = ros::this_node::getName();
  const bool unknown = ros::master::check() && !ros::master::execute("lookupNode", request, response, payload, false);
  lost_ = unknown && unknown_;
  unknown_ = unknown;
  if (!lost_) return;
  ROS_FATAL("the master does not know this node any more; it ends, so that roslaunch may start it again");
  timer_.stop();
  ros::shutdown();
}

}  // namespace tissue_stiffness
