#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Cuts every tetrahedron into eight (red refinement: four at the corners, four around the shortest diagonal of the inner
/// octahedron). Corners keep their numbers; a 10-node mesh's mid-edge nodes become corners at the same numbers, curved
/// edges stay, and new mid-edge nodes lie on the quadratic geometry.
TetMesh refine(const TetMesh& mesh);

}  // namespace tissue_stiffness
