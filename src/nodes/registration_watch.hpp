#pragma once

#include <ros/node_handle.h>

namespace tissue_stiffness {

/// Ends the node when its master has forgotten it. A master that is started again does not know the nodes of before, and
/// no new subscriber or publisher finds them. With `respawn` roslaunch then starts the node anew.
class RegistrationWatch {
 public:
  explicit RegistrationWatch(ros::NodeHandle node);

  bool lost() const { return lost_; }

 private:
  void check();

  bool unknown_ = false;  ///< to the master, when it was last asked
  bool lost_ = false;
  ros::WallTimer timer_;
};

}  // namespace tissue_stiffness
