#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Returns the matrix [v] with [v] x = v x x for every x.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

}  // namespace tissue_stiffness
