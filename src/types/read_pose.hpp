#pragma once

#include <Eigen/Geometry>
#include <string>

namespace tissue_stiffness {

/// Returns the quaternion with length 1. Throws InputError, naming `where`, for one whose length is off by more than 1e-3.
Eigen::Quaterniond unit_rotation(const Eigen::Quaterniond& rotation, const std::string& where);

/// Returns the 12 values of a load sample (pose_values) for a position and a quaternion x, y, z, qx, qy, qz, qw. Throws as
/// unit_rotation does.
Eigen::VectorXd read_pose(const Eigen::Matrix<double, 7, 1>& numbers, const std::string& where);

}  // namespace tissue_stiffness
