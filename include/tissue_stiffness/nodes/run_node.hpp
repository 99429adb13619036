#pragma once

#include <ros/ros.h>

#include <exception>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// Runs a node until shutdown. A wrong setting is one fatal line and exit code 2.
template <typename Node>
int run_node() {
  const ros::NodeHandle node_handle;  // with the last handle ROS shuts down, and its log too
  try {
    Node node(node_handle, ros::NodeHandle("~"));
    ros::spin();
    return node.exit_code();
  } catch (const InputError& error) {
    ROS_FATAL("%s", error.what());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}

}  // namespace tissue_stiffness
