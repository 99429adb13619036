#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Turns 4-node tetrahedra into straight-edged 10-node ones: one node in the middle of every edge, shared by all tetrahedra
/// around it, appended behind the corners. Facets, when there are any, are set anew.
void elevate(TetMesh& mesh);

/// Drops the mid-edge nodes of 10-node tetrahedra: what is left is the 4-node mesh of the same corners.
void drop_mid_nodes(TetMesh& mesh);

}  // namespace tissue_stiffness
