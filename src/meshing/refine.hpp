#pragma once

#include <map>
#include <string>

#include "tissue_stiffness/types/tet_mesh.hpp"
#include "types/prolongation.hpp"

namespace tissue_stiffness {

/// Cuts every tetrahedron into eight (red refinement: four at the corners, four around the shortest diagonal of the inner
/// octahedron). Corners keep their numbers. A 10-node mesh's mid-edge nodes become corners with unchanged numbers, curved
/// edges stay, and new mid-edge nodes lie on the quadratic geometry.
TetMesh refine_mesh(const TetMesh& mesh);

/// Returns the regions on refine_mesh(mesh). They consist of the children of each region's facets and tetrahedra, whatever
/// shape defined the region.
std::map<std::string, Region> refine_regions(const std::map<std::string, Region>& regions, const TetMesh& mesh,
                                             const TetMesh& refined);

/// Returns the matrix that interpolates nodal values of `mesh` at the nodes of refine_mesh(mesh). It is exact for what is
/// quadratic in each tetrahedron of `mesh`, or linear when that has no mid-edge nodes.
Prolongation prolongation(const TetMesh& mesh, const TetMesh& refined);

}  // namespace tissue_stiffness
