#pragma once

#include <Eigen/Geometry>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A rigid motion and the distance that remains after it.
struct RigidFit {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  double rms = 0.0;  ///< root mean square distance after the motion [m]
};

/// Returns the rigid motion of `from` that minimises sum |R from_i + t - to_i|^2 (Kabsch 1976; Umeyama 1991 without scale).
/// For points on one line, or fewer than three, only the translation is found.
RigidFit fit_pairs(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// Returns the rigid motion of points without identity onto the mesh's surface at rest. It uses the iterative closest point
/// method (Besl & McKay 1992), started from the points' own position and with coinciding centroids. The better result is
/// returned.
RigidFit fit_surface(const Eigen::Matrix3Xd& points, const TetMesh& mesh);

/// Returns the root mean square distance of points from the surface at rest [m].
double distance_from_surface(const Eigen::Matrix3Xd& points, const TetMesh& mesh);

}  // namespace tissue_stiffness
