#pragma once

#include <Eigen/Geometry>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A rigid motion and what it leaves.
struct RigidFit {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  double rms = 0.0;  ///< root mean square distance after the motion [m]
};

/// The rigid motion of `from` that minimises sum |R from_i + t - to_i|^2 (Kabsch 1976; Umeyama 1991 without scale). Of
/// points on one line, or fewer than three, only the translation is found.
RigidFit fit_pairs(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// The rigid motion of points without identity onto the mesh's surface at rest: iterative closest point (Besl & McKay
/// 1992), from where they are and from centroid on centroid; the better of both.
RigidFit fit_surface(const Eigen::Matrix3Xd& points, const TetMesh& mesh);

/// Root mean square distance of points from the surface at rest [m].
double distance_from_surface(const Eigen::Matrix3Xd& points, const TetMesh& mesh);

}  // namespace tissue_stiffness
