#include <limits>

#include "meshing/bend_boundary.hpp"
#include "meshing/bodies.hpp"

namespace tissue_stiffness {
namespace {

// Returns the straight positions of the mid-edge nodes on the boundary, and NaN for all others.
Eigen::Matrix3Xd straight_boundary(const TetMesh& mesh) {
  Eigen::Matrix3Xd straight = Eigen::Matrix3Xd::Constant(3, mesh.node_count(), std::numeric_limits<double>::quiet_NaN());
  for (int f = 0; f < mesh.facet_count(); ++f) {
    for (int side = 0; side < 3; ++side) {
      straight.col(mesh.facets(3 + side, f)) =
          0.5 * (mesh.nodes.col(mesh.facets(side, f)) + mesh.nodes.col(mesh.facets((side + 1) % 3, f)));
    }
  }
  return straight;
}

}  // namespace

void curve_boundary(TetMesh& mesh, const RevolutionProfile& profile) {
  if (!mesh.quadratic()) return;
  Eigen::Matrix3Xd targets = straight_boundary(mesh);
  for (int node = mesh.corner_count; node < mesh.node_count(); ++node) {
    if (targets.col(node).allFinite()) targets.col(node) = profile.project(targets.col(node));
  }
  bend_boundary(mesh, targets);
}

}  // namespace tissue_stiffness
