#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Returns the weights of the corners a, b and c at the point of their triangle that is closest to p (Ericson 2005, sec.
/// 5.1.5). They sum to 1, and those of corners that do not bound the point's edge or vertex are exactly 0.
Eigen::Vector3d closest_weights(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c);

/// Returns that point.
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

}  // namespace tissue_stiffness
