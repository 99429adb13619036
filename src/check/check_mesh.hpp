#pragma once

#include <Eigen/Core>

#include "check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Checks a body with these extents [m] and volume [m^3]. A body above 2.5 m (taller than a person) is probably in mm, and
/// one below 0.1 mm was already in m. A `max_edge_length` that divides the body into more than 10^7 regular tetrahedra, of
/// edge^3 / (6 sqrt(2)) each, would keep TetGen busy for too long.
SetupFindings check_extent(const MeshSettings& settings, const Eigen::Vector3d& extent, double volume);

/// Checks the extent of the mesh file, before TetGen or anything else works on it. That work would take as long as the mesh
/// is large. Returns nothing for a mesh that is made from a contour. Throws InputError for a file that cannot be read.
SetupFindings check_mesh_file(const MeshSettings& settings);

}  // namespace tissue_stiffness
