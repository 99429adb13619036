#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A point of the surface at rest, by the tetrahedron that carries it.
struct SurfaceAnchor {
  int tet;
  Eigen::VectorXd shape;      ///< shape functions of the tetrahedron's nodes at the point
  Eigen::Matrix3Xd gradient;  ///< their gradients there [1/m]
  int node;                   ///< mesh node nearest to the point

  /// Returns the point's displacement; u: 3n [m].
  Eigen::Vector3d displacement(const TetMesh& mesh, const Eigen::Ref<const Eigen::VectorXd>& u) const;
};

/// Returns the anchor of a point [m] on a facet at rest, in the coordinates that the straight corners of the facet's
/// tetrahedron define.
SurfaceAnchor anchor_on(const TetMesh& mesh, int facet, const Eigen::Vector3d& point);

}  // namespace tissue_stiffness
