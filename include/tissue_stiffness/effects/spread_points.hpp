#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Places spread evenly over a body.
struct SpreadPoints {
  Eigen::Matrix3Xd points;  ///< [m]
  double distance;          ///< typical, between neighbours [m]
};

/// Centres of a k-means partition of the volume (Lloyd 1982) from a farthest-point start: the same for the same mesh.
SpreadPoints spread_points(const TetMesh& mesh, int count);

}  // namespace tissue_stiffness
