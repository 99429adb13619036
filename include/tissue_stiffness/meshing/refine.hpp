#pragma once

#include <map>
#include <string>

#include "tissue_stiffness/types/prolongation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Cuts every tetrahedron into eight (red refinement: four at the corners, four around the shortest diagonal of the inner
/// octahedron). Corners keep their numbers; a 10-node mesh's mid-edge nodes become corners at the same numbers, curved
/// edges stay, and new mid-edge nodes lie on the quadratic geometry.
TetMesh refine(const TetMesh& mesh);

/// The same parts of the body on refine(mesh): the children of a region's facets and tetrahedra, whatever shape the region
/// was cut out with.
std::map<std::string, Region> refine(const std::map<std::string, Region>& regions, const TetMesh& mesh,
                                     const TetMesh& refined);

/// Values at the nodes of refine(mesh) of what is quadratic in each tetrahedron of `mesh` (linear, when that has no
/// mid-edge nodes).
Prolongation prolongation(const TetMesh& mesh, const TetMesh& refined);

}  // namespace tissue_stiffness
