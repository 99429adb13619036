#include "nodes/registration_watch.hpp"

#include <ros/master.h>
#include <ros/ros.h>

namespace tissue_stiffness {
namespace {

constexpr double kPeriod = 5.0;  // [s]

}  // namespace

RegistrationWatch::RegistrationWatch(ros::NodeHandle node)
    : timer_(node.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { check(); })) {}

// A topic or service that the node registers later makes its name known to the new master. So the watch asks for the
// service that roscpp registers once, when the node starts. One answer is not enough, because that takes a moment.
void RegistrationWatch::check() {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = ros::this_node::getName() + "/get_loggers";
  const bool unknown = ros::master::check() && !ros::master::execute("lookupService", request, response, payload, false);
  lost_ = unknown && unknown_;
  unknown_ = unknown;
  if (!lost_) return;
  ROS_FATAL("the master does not know this node any more; it ends, so that roslaunch may start it again");
  timer_.stop();
  ros::shutdown();
}

}  // namespace tissue_stiffness
