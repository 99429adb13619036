#include "types/read_pose.hpp"

#include <cmath>

#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kUnitLength = 1e-3;  // by which the length of a quaternion may be off

}  // namespace

Eigen::Quaterniond unit_rotation(const Eigen::Quaterniond& rotation, const std::string& where) {
  if (!(std::abs(rotation.norm() - 1.0) < kUnitLength)) {
    throw InputError(where, "a quaternion of length " + std::to_string(rotation.norm()), "length 1");
  }
  return rotation.normalized();
}

Eigen::VectorXd read_pose(const Eigen::Matrix<double, 7, 1>& numbers, const std::string& where) {
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  return pose_values(Eigen::Translation3d(numbers.head<3>()) * unit_rotation(rotation, where));
}

}  // namespace tissue_stiffness
