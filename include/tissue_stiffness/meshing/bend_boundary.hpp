#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Moves the mid-edge nodes of a straight-edged 10-node mesh to `targets` (3 x nodes; NaN leaves a node where it is), but
/// straightens elements again that this would bend beyond use. Returns the number of nodes put back.
int bend_boundary(TetMesh& mesh, const Eigen::Matrix3Xd& targets);

/// Guesses the smooth surface behind flat facets: mid-edge nodes of boundary edges that fold by less than 40 degrees go to
/// the middle of the cubic through both ends, normal to the averaged normals there (the edges of PN triangles: Vlachos et
/// al. 2001). Edges that fold more stay straight. A mesh without mid-edge nodes, or one that is curved already, stays as it
/// is.
void smooth_boundary(TetMesh& mesh);

}  // namespace tissue_stiffness
