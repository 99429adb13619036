#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Moves the mid-edge nodes of a straight-edged 10-node mesh to `targets` (3 x nodes; NaN leaves a node where it is).
/// Elements that this would bend too much are straightened again. Returns the number of nodes put back.
int bend_boundary(TetMesh& mesh, const Eigen::Matrix3Xd& targets);

/// Estimates the smooth surface that flat facets approximate. The mid-edge nodes of boundary edges that fold by less than
/// 40 degrees move to the middle of a cubic. It passes through both ends, normal to the averaged normals there (the edges
/// of PN triangles: Vlachos et al. 2001). Edges that fold more stay straight. A mesh without mid-edge nodes, or one that is
/// already curved, is not changed.
void smooth_boundary(TetMesh& mesh);

}  // namespace tissue_stiffness
