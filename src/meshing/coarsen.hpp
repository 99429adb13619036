#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns the mesh that refine_mesh() made this one from. Nodes keep their numbers, and so do tetrahedra and facets.
/// Throws InputError for a mesh that it did not make.
TetMesh coarsen_mesh(const TetMesh& refined);

}  // namespace tissue_stiffness
