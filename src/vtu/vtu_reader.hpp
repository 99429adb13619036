#pragma once

#include <string>

#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

/// Reads the tetrahedra of VTK's XML unstructured grid (.vtu) by VTK's own reader, in another process. The cells are those
/// of read_vtk, and data at points and cells are left out. Throws InputError with what VTK says of the file.
TetFile read_vtu(const std::string& file);

/// Lets load_tet_mesh read `.vtu`. A program calls this at its start, and loads VTK for it.
void accept_vtu_meshes();

}  // namespace tissue_stiffness
