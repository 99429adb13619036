#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// A body of these extents [m] and volume [m^3]: one above 2.5 m (taller than a person) is probably in mm, one below 0.1 mm
/// was in m already; and a `max_edge_length` that divides it into more than 10^7 regular tetrahedra, of edge^3 / (6
/// sqrt(2)) each, keeps TetGen busy for longer than anybody waits.
SetupFindings check_extent(const MeshSettings& settings, const Eigen::Vector3d& extent, double volume);

/// The same of the mesh file, before TetGen or anything else works on it: that would take as long as the mesh is large.
/// Empty for a mesh that is made from a contour. Throws InputError for a file that cannot be read.
SetupFindings check_mesh_file(const MeshSettings& settings);

}  // namespace tissue_stiffness
