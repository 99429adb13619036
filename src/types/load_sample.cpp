#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {

int component_count(LoadInput::Kind kind) {
  switch (kind) {
    case LoadInput::Kind::pressure:
      return 1;
    case LoadInput::Kind::wrench:
      return 6;
    case LoadInput::Kind::pose:
      break;
  }
  return 12;
}

const char* message_type(LoadInput::Kind kind) {
  switch (kind) {
    case LoadInput::Kind::pressure:
      return "sensor_msgs/FluidPressure";
    case LoadInput::Kind::wrench:
      return "geometry_msgs/WrenchStamped";
    case LoadInput::Kind::pose:
      break;
  }
  return "geometry_msgs/PoseStamped";
}

Eigen::VectorXd pose_values(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  Eigen::VectorXd out(12);
  out << pose.translation(), Eigen::Map<const Eigen::VectorXd>(rotation.data(), 9);
  return out;
}

}  // namespace tissue_stiffness
