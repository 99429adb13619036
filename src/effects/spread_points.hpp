#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Places spread evenly over a body.
struct SpreadPoints {
  Eigen::Matrix3Xd points;  ///< [m]
  double distance;          ///< typical distance between neighbours [m]
};

/// Returns the centres of a k-means partition of the volume (Lloyd 1982), started from a farthest-point selection. The
/// result depends only on the mesh.
SpreadPoints spread_points(const TetMesh& mesh, int count);

}  // namespace tissue_stiffness
