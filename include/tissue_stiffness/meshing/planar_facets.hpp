#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/meshing/triangle_surface.hpp"

namespace tissue_stiffness {

/// A closed surface of plane polygons.
struct PlanarFacets {
  struct Facet {
    std::vector<std::vector<int>> loops;  ///< vertex numbers: outline counter-clockwise seen from outside, holes clockwise
    Eigen::Vector3d normal;               ///< unit, outwards
  };
  Eigen::Matrix3Xd vertices;  ///< [m]
  std::vector<Facet> facets;
};

/// Joins neighbouring triangles that lie in one plane within `tolerance` [m] and drops the vertices that only subdivided
/// planes and straight edges. The surface must be watertight and oriented.
PlanarFacets merge_coplanar(const TriangleSurface& surface, double tolerance);

/// Cuts every edge longer than `length` [m] into equal parts no longer than that; facets that share the edge share its
/// points.
void subdivide_edges(PlanarFacets& facets, double length);

/// The facets cut into triangles without further vertices. (TetGen 1.5 does that itself, but may not come to an end where
/// vertices lie along one side.)
TriangleSurface triangulate(const PlanarFacets& facets);

}  // namespace tissue_stiffness
