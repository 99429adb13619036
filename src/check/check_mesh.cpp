#include "check/check_mesh.hpp"

#include "check/words.hpp"
#include "meshing/mesh_limits.hpp"
#include "meshing/surface.hpp"
#include "meshing/triangle_surface.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLargest = 2.5, kSmallest = 1e-4;  // [m] taller than a person; what a camera hardly sees

std::string shown_extent(const Eigen::Vector3d& extent) {
  return plain_number(extent.x()) + " x " + plain_number(extent.y()) + " x " + plain_number(extent.z()) + " m";
}

Eigen::Vector3d extent_of(const Eigen::Matrix3Xd& points) {
  return points.rowwise().maxCoeff() - points.rowwise().minCoeff();
}

}  // namespace

SetupFindings check_extent(const MeshSettings& settings, const Eigen::Vector3d& extent, double volume) {
  const std::string bodies = "bodies of 0.1 mm to 2.5 m are expected";
  const std::string scale = "mesh.scale (" + plain_number(settings.scale) + ")";
  if (extent.maxCoeff() > kLargest) {
    return {{"mesh.scale", scale + ": the mesh of " + settings.file + " is " + shown_extent(extent) + " large, and " +
                               bodies + "; if the file is in mm, write `scale: " + plain_number(1e-3 * settings.scale) +
                               "`."}};
  }
  if (extent.maxCoeff() < kSmallest) {
    return {{"mesh.scale", scale + ": the mesh of " + settings.file + " is " + shown_extent(extent) + " large, and " +
                               bodies + "; if the file is in m already, write `scale: 1`."}};
  }
  const double edge = settings.max_edge_length;
  const double tets = edge > 0.0 ? tetrahedra_of(volume, edge) : 0.0;
  if (tets > kMostTetrahedra) {
    return {{"mesh.max_edge_length",
             "mesh.max_edge_length: edges of " + plain_number(edge) + " m divide the mesh of " + settings.file + " (" +
                 shown_extent(extent) + ") into about " + plain_number(tets, 1) +
                 " tetrahedra, and 10000000 are the most that can be worked with; make it larger, or mend mesh.scale."}};
  }
  return {};
}

SetupFindings check_mesh_file(const MeshSettings& settings) {
  if (settings.source != MeshSettings::Source::file) return {};
  if (is_tet_file(settings.file)) {
    MeshSettings tets = settings;
    tets.max_edge_length = 0.0;  // it is for surfaces
    const TetMesh mesh = load_tet_mesh(settings.file, settings.scale, 1);
    return check_extent(tets, extent_of(mesh.nodes), mesh_volume(mesh));
  }
  if (!is_surface_file(settings.file)) return {};  // build_mesh says which endings there are
  const TriangleSurface surface = load_surface(settings.file, settings.scale);
  return check_extent(settings, extent_of(surface.vertices), enclosed_volume(surface));
}

}  // namespace tissue_stiffness
