#include "tissue_stiffness/meshing/build_mesh.hpp"

#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

TetMesh build_mesh(const MeshSettings& settings) {
  return load_tet_mesh(settings.file, settings.scale, settings.order);
}

}  // namespace tissue_stiffness
