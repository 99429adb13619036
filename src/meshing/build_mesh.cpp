#include "tissue_stiffness/meshing/build_mesh.hpp"

#include "tissue_stiffness/meshing/file_ending.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"
#include "tissue_stiffness/meshing/tet_file_check.hpp"
#include "tissue_stiffness/meshing/tetgen_mesher.hpp"
#include "tissue_stiffness/meshing/triangle_surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

TetMesh build_mesh(const MeshSettings& settings) {
  if (is_tet_file(settings.file)) return load_tet_mesh(settings.file, settings.scale, settings.order);
  const std::string where = "mesh file " + settings.file;
  if (!is_surface_file(settings.file)) {
    throw InputError(where, "ending '" + file_ending(settings.file) + "'", ".vtk, .node, .ele, .msh, .stl, .ply or .obj");
  }
  const TriangleSurface surface = load_surface(settings.file, settings.scale);
  return check_tet_file(fill_surface(surface, settings.max_edge_length, false, where), 1.0, settings.order, where);
}

}  // namespace tissue_stiffness
