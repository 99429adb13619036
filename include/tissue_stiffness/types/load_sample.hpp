#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

namespace tissue_stiffness {

/// One measured value of what drives the model: a load, or the pose of a body that a region follows.
struct LoadSample {
  std::string topic;
  double time = 0.0;      ///< [s] on the recording's clock
  Eigen::VectorXd value;  ///< in the model frame, see LoadInput::Kind
};

/// A topic from which the model needs load samples.
struct LoadInput {
  enum class Kind {
    pressure,  ///< 1 value [Pa]
    wrench,    ///< force [N] and torque [N m]
    pose       ///< 12 values: position [m] and the columns of the rotation matrix
  };
  std::string topic;
  Kind kind = Kind::pressure;
};

/// Returns the number of values of a sample.
int component_count(LoadInput::Kind kind);
/// Returns the type of the messages that carry it, as ROS names it.
const char* message_type(LoadInput::Kind kind);
/// Returns the 12 values of a pose in the model frame.
Eigen::VectorXd pose_values(const Eigen::Isometry3d& pose);

}  // namespace tissue_stiffness
