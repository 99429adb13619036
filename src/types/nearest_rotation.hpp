#pragma once

#include <Eigen/Core>
#include <Eigen/SVD>

namespace tissue_stiffness {

/// Returns the rotation R of the polar decomposition F = R U. F must have a positive determinant.
inline Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& f) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace tissue_stiffness
