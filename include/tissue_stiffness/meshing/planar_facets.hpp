#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/meshing/triangle_surface.hpp"

namespace tissue_stiffness {

/// A closed surface of plane polygons, the input of a tetrahedral mesher.
struct PlanarFacets {
  struct Facet {
    std::vector<std::vector<int>> loops;       ///< outline and outlines of holes, vertex numbers
    std::vector<Eigen::Vector3d> hole_points;  ///< a point inside each hole
  };
  Eigen::Matrix3Xd vertices;  ///< [m]
  std::vector<Facet> facets;
};

/// Every triangle as a facet of its own.
PlanarFacets triangles_as_facets(const TriangleSurface& surface);

/// Joins neighbouring triangles that lie in one plane within `tolerance` [m] and drops the vertices that only subdivided
/// planes and straight edges, so that a mesher is free to choose its own there. The surface must be watertight and
/// oriented.
PlanarFacets merge_coplanar(const TriangleSurface& surface, double tolerance);

/// Cuts every edge longer than `length` [m] into equal parts no longer than that; facets that share the edge share its
/// points.
void subdivide_edges(PlanarFacets& facets, double length);

}  // namespace tissue_stiffness
