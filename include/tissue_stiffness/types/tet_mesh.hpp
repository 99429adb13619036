#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// Tetrahedral mesh at rest. Corner nodes come first and keep the numbers of the file they were read from. The mid-edge
/// nodes of a 10-node mesh follow them.
///
/// Node order in a tetrahedron: corners 0-3 with positive volume (x1-x0) x (x2-x0) . (x3-x0) > 0, then the mid nodes of the
/// edges 01, 12, 02, 03, 13, 23. Node order in a facet: corners 0-2, counter-clockwise seen from outside, then the mid
/// nodes of 01, 12, 20.
struct TetMesh {
  Eigen::Matrix3Xd nodes;     ///< 3 x node count [m]
  Eigen::MatrixXi tets;       ///< 4 or 10 x tetrahedron count
  Eigen::MatrixXi facets;     ///< 3 or 6 x boundary facet count
  Eigen::VectorXi facet_tet;  ///< tetrahedron that each facet belongs to
  int corner_count = 0;       ///< number of corner nodes

  int node_count() const { return static_cast<int>(nodes.cols()); }
  int tet_count() const { return static_cast<int>(tets.cols()); }
  int facet_count() const { return static_cast<int>(facets.cols()); }
  bool quadratic() const { return tets.rows() == 10; }
  bool empty() const { return tets.cols() == 0; }
};

/// A named part of a mesh, evaluated at rest.
struct Region {
  std::vector<int> nodes;   ///< all nodes inside the region, ascending
  std::vector<int> facets;  ///< boundary facets whose corners are all inside, ascending
  std::vector<int> tets;    ///< tetrahedra whose centroid is inside, ascending
};

}  // namespace tissue_stiffness
