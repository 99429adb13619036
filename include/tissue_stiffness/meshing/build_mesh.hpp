#pragma once

#include <functional>
#include <map>
#include <string>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Mesh of `mesh: {file: ...}` in the order asked for. Throws InputError for a file that is missing, unreadable, open,
/// self-intersecting or that holds inverted elements, saying where. `checkpoint` is called now and then; what it throws
/// ends the meshing.
TetMesh build_mesh(
    const MeshSettings& settings, const std::function<void()>& checkpoint = [] {});

/// Mesh of `mesh: {revolve: ...}` or `{extrude: ...}` from the first segmented contour and the camera that saw it. The
/// contour's outline is placed in the plane through the model's axis (revolve) or through the model's origin (extrude)
/// facing the camera; the pinhole's perspective bias (a sphere's outline is larger than its equator) is removed.
TetMesh build_mesh(
    const MeshSettings& settings, const Contour& contour, const Camera& camera,
    const std::function<void()>& checkpoint = [] {});

/// Resolves named regions on the rest mesh. Throws InputError for a region that holds nothing or a vertex out of range.
std::map<std::string, Region> resolve_regions(const std::vector<RegionSettings>& settings, const TetMesh& mesh);

}  // namespace tissue_stiffness
