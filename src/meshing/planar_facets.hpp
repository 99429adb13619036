#pragma once

#include <Eigen/Core>
#include <vector>

#include "meshing/triangle_surface.hpp"

namespace tissue_stiffness {

/// A closed surface that consists of plane polygons.
struct PlanarFacets {
  struct Facet {
    std::vector<std::vector<int>> loops;  ///< vertex numbers: outline counter-clockwise from outside, holes clockwise
    Eigen::Vector3d normal;               ///< outward unit normal
  };
  Eigen::Matrix3Xd vertices;  ///< [m]
  std::vector<Facet> facets;
};

/// Joins neighbouring triangles that lie in one plane within `tolerance` [m]. Vertices that only subdivide planes and
/// straight edges are dropped. The surface must be watertight and oriented.
PlanarFacets merge_coplanar(const TriangleSurface& surface, double tolerance);

/// Divides every edge longer than `length` [m] into equal parts no longer than that. Facets that share an edge share its
/// points.
void subdivide_edges(PlanarFacets& facets, double length);

/// Cuts the facets into triangles without further vertices. TetGen 1.5 can do this itself, but it may not terminate where
/// vertices lie along one side.
TriangleSurface triangulate(const PlanarFacets& facets);

}  // namespace tissue_stiffness
