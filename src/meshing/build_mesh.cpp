#include "tissue_stiffness/meshing/build_mesh.hpp"

#include <cmath>
#include <sstream>

#include "meshing/bend_boundary.hpp"
#include "meshing/bodies.hpp"
#include "meshing/file_ending.hpp"
#include "meshing/mesh_limits.hpp"
#include "meshing/refine.hpp"
#include "meshing/tet_file_check.hpp"
#include "meshing/tetgen_mesher.hpp"
#include "meshing/triangle_surface.hpp"
#include "meshing/viewing_rays.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

double longest_side(const TriangleSurface& surface) {
  return (surface.vertices.rowwise().maxCoeff() - surface.vertices.rowwise().minCoeff()).maxCoeff();
}

TetMesh fill(const TriangleSurface& surface, const MeshSettings& settings, bool keep_triangles, const std::string& where,
             const std::function<void()>& checkpoint) {
  check_edge_length(settings.max_edge_length, longest_side(surface), enclosed_volume(surface), where);
  return check_tet_file(fill_surface(surface, settings.max_edge_length, keep_triangles, where, checkpoint), 1.0,
                        settings.order, where);
}

void require_positive(const std::string& key, double value) {
  if (value > 0.0) return;
  throw InputError("mesh." + key, std::to_string(value) + " m", "above 0 m for a mesh from a contour");
}

TetMesh refined(const MeshSettings& settings, TetMesh mesh) {
  const double count = std::pow(8.0, settings.refine) * static_cast<double>(mesh.tets.cols());
  if (settings.refine > 0 && count > kMostTetrahedra) {
    std::ostringstream found, allowed;
    found << settings.refine << ", which makes " << count << " tetrahedra";
    allowed << "at most " << kMostTetrahedra << " tetrahedra";
    throw InputError("mesh.refine", found.str(), allowed.str());
  }
  for (int k = 0; k < settings.refine; ++k) mesh = refine_mesh(mesh);
  return mesh;
}

TetMesh mesh_of_file(const MeshSettings& settings, const std::function<void()>& checkpoint) {
  if (is_tet_file(settings.file))
    return smooth_unless_faceted(settings, load_tet_mesh(settings.file, settings.scale, settings.order));
  const std::string where = "mesh file " + settings.file;
  if (!is_surface_file(settings.file)) {
    throw InputError(where, "ending '" + file_ending(settings.file) + "'", tet_endings() + ", .stl, .ply or .obj");
  }
  const TriangleSurface surface = load_surface(settings.file, settings.scale);
  return smooth_unless_faceted(settings, fill(surface, settings, false, where, checkpoint));
}

TetMesh mesh_of_contour(const MeshSettings& settings, const Contour& contour, const Camera& camera,
                        const std::function<void()>& checkpoint) {
  check_outline(contour);
  require_positive("max_edge_length", settings.max_edge_length);
  if (settings.source == MeshSettings::Source::extrude) {
    require_positive("depth", settings.depth);
    const TriangleSurface surface = extruded_surface(contour, camera, settings.depth, settings.max_edge_length);
    return smooth_unless_faceted(settings, fill(surface, settings, false, "mesh.extrude", checkpoint));
  }
  const ProfileFit fit = fit_profile(viewing_rays(contour, camera), camera, settings.axis);
  // The surface itself is made of such edges.
  check_edge_length(settings.max_edge_length, fit.profile.radius(0.0) + fit.profile.radius(M_PI), 0.0, "mesh.revolve");
  TetMesh mesh =
      fill(revolution_surface(fit.profile, settings.max_edge_length), settings, true, "mesh.revolve", checkpoint);
  curve_boundary(mesh, fit.profile);
  return mesh;
}

}  // namespace

TetMesh build_mesh(const MeshSettings& settings, const std::function<void()>& checkpoint) {
  return refined(settings, mesh_of_file(settings, checkpoint));
}

TetMesh build_mesh(const MeshSettings& settings, const Contour& contour, const Camera& camera,
                   const std::function<void()>& checkpoint) {
  if (settings.source == MeshSettings::Source::file) return build_mesh(settings, checkpoint);
  return refined(settings, mesh_of_contour(settings, contour, camera, checkpoint));
}

}  // namespace tissue_stiffness
