#pragma once

#include <string>

#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

/// Checks tetrahedra from a file as described at load_tet_mesh and returns their TetMesh. Messages begin with `where`.
TetMesh check_tet_file(const TetFile& input, double scale, int order, const std::string& where);

/// Checks a mesh that somebody else has made: its size (mesh_limits.hpp), tetrahedra without volume or inside out, and
/// facets that are no faces of their tetrahedra. Throws InputError, naming `where` and the place.
void check_tet_mesh(const TetMesh& mesh, const std::string& where);

}  // namespace tissue_stiffness
