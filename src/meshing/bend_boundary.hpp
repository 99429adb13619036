#pragma once

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Moves the mid-edge nodes of a straight-edged 10-node mesh to `targets` (3 x nodes; NaN leaves a node free). Free ones
/// follow their neighbours. Elements that this would bend too much are straightened in steps.
void bend_boundary(TetMesh& mesh, const Eigen::Matrix3Xd& targets);

/// Estimates the smooth surface that flat facets approximate. The mid-edge nodes of boundary edges that fold by less than
/// 60 degrees move to the middle of a cubic. It passes through both ends, normal to the mean normals there (the edges of PN
/// triangles: Vlachos et al. 2001). Two surfaces meet at an edge that folds more, which follows both. A mesh without
/// mid-edge nodes, or one that is already curved, is not changed.
void smooth_boundary(TetMesh& mesh);
/// Returns the mesh with a smooth boundary, unless its facets are declared to be the body's own.
TetMesh smooth_unless_faceted(const MeshSettings& settings, TetMesh mesh);

}  // namespace tissue_stiffness
