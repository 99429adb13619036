#pragma once

#include <ros/ros.h>

#include <exception>

#include "nodes/registration_watch.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// Runs a node until shutdown. A wrong setting is logged as one fatal line and gives exit code 2, and a master that has
/// forgotten the node gives 1.
template <typename Node>
int run_node() {
  const ros::NodeHandle node_handle;  // when the last handle goes, ROS shuts down with its log
  try {
    Node node(node_handle, ros::NodeHandle("~"));
    const RegistrationWatch registration(node_handle);
    ros::spin();
    return registration.lost() ? 1 : node.exit_code();
  } catch (const InputError& error) {
    ROS_FATAL("%s", error.what());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}

}  // namespace tissue_stiffness
