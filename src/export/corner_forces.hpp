#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns forces on the corners of the tetrahedra alone. Half of the force on each edge's node goes to both corners, which
/// is the load of 4-node tetrahedra, as their displacement is linear along an edge.
Eigen::Matrix3Xd corner_forces(const TetMesh& mesh, const Eigen::Matrix3Xd& force);

}  // namespace tissue_stiffness
