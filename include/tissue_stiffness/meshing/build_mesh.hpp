#pragma once

#include <functional>
#include <map>
#include <string>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Makes the mesh of `mesh: {file: ...}` in the requested order, and refines it as often as asked. Nodes keep their
/// numbers. Throws InputError, naming the place, for a file that is missing, unreadable, open or self-intersecting, or that
/// holds inverted elements, and for more tetrahedra than can be worked with. `checkpoint` is called now and then; an
/// exception from it ends the meshing.
TetMesh build_mesh(
    const MeshSettings& settings, const std::function<void()>& checkpoint = [] {});

/// Makes the mesh of `mesh: {revolve: ...}` or `{extrude: ...}` from the first segmented contour and the camera that
/// recorded it. The outline is placed in the plane that faces the camera and passes through the model's axis (revolve) or
/// through the model's origin (extrude). The pinhole's perspective bias is removed: a sphere's outline is larger than its
/// equator.
TetMesh build_mesh(
    const MeshSettings& settings, const Contour& contour, const Camera& camera,
    const std::function<void()>& checkpoint = [] {});

/// Evaluates named regions on the rest mesh. A mesh that was refined has the regions of the mesh that it was made from.
/// What lies at a region's border would be inside on one mesh and outside on the other. Throws InputError for a region that
/// holds nothing, a vertex out of range, or a mesh that was not refined so often.
std::map<std::string, Region> resolve_regions(const std::vector<RegionSettings>& settings, const TetMesh& mesh,
                                              int times_refined = 0);
/// Returns the regions of a model's mesh.
std::map<std::string, Region> resolve_regions(const ModelSettings& settings, const TetMesh& mesh);

}  // namespace tissue_stiffness
