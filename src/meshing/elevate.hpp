#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Turns 4-node tetrahedra into straight-edged 10-node ones. Every edge gets one node in its middle, which all tetrahedra
/// around it share. The new nodes follow the corners. Facets, if there are any, are set again.
void elevate_to_quadratic(TetMesh& mesh);

/// Removes the mid-edge nodes of 10-node tetrahedra. What remains is the 4-node mesh of the same corners.
void drop_mid_nodes(TetMesh& mesh);

}  // namespace tissue_stiffness
