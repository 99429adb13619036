#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A point of the surface.
struct SurfacePoint {
  int facet = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, outward
  double distance = 0.0;                             ///< from the query, >= 0 [m]
};

/// Closest point of a triangle (Ericson 2005, sec. 5.1.5).
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

/// Closest point of the rest surface by looking at every facet (corners only).
SurfacePoint closest_surface_point(const TetMesh& mesh, const Eigen::Vector3d& query);

/// Surface as plain triangles: a 6-node facet gives four. 3 x count, node numbers, counter-clockwise from outside; `facet`
/// tells which facet each came from.
struct SurfaceTriangles {
  Eigen::Matrix3Xi nodes;
  std::vector<int> facet;
};
SurfaceTriangles split_facets(const TetMesh& mesh, const std::vector<int>& facets);
SurfaceTriangles split_facets(const TetMesh& mesh);

}  // namespace tissue_stiffness
