#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Returns the diagonal of the box around these points [m].
inline double body_size(const Eigen::Matrix3Xd& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

}  // namespace tissue_stiffness
