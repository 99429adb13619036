#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A surface point is the foot of a query on the surface.
struct SurfacePoint {
  int facet = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit vector, outward
  double distance = 0.0;                             ///< from the query point, >= 0 [m]
};

/// Returns the point of the rest surface that is closest to `query`. It tests every facet, as the triangle of its corners.
SurfacePoint closest_surface_point(const TetMesh& mesh, const Eigen::Vector3d& query);

/// Returns the first point of the rest surface that a ray from outside meets, as the triangles of the facets' corners; the
/// distance is that along the ray. The facet is -1 where it meets none. `direction` is a unit vector.
SurfacePoint first_surface_point(const TetMesh& mesh, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// The surface is split into plain triangles; a 6-node facet gives four. `nodes` is 3 x count and holds node numbers,
/// counter-clockwise from outside. `facet` tells which facet each triangle came from.
struct SurfaceTriangles {
  Eigen::Matrix3Xi nodes;
  std::vector<int> facet;
};
SurfaceTriangles split_facets(const TetMesh& mesh, const std::vector<int>& facets);
SurfaceTriangles split_facets(const TetMesh& mesh);

}  // namespace tissue_stiffness
