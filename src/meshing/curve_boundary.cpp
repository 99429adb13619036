#include <limits>
#include <vector>

#include "meshing/bend_boundary.hpp"
#include "meshing/bodies.hpp"
#include "meshing/quality.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastJacobianRatio = 0.1;  // an element bent more than this is straightened

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

int bend_boundary(TetMesh& mesh, const Eigen::Matrix3Xd& targets) {
  const Eigen::Matrix3Xd straight = mesh.nodes;
  for (int node = mesh.corner_count; node < mesh.node_count(); ++node) {
    if (targets.col(node).allFinite()) mesh.nodes.col(node) = targets.col(node);
  }
  std::vector<bool> straightened(static_cast<std::size_t>(mesh.node_count()), false);
  int count = 0;
  for (bool changed = true; changed;) {  // straightening one element bends its neighbours less, but unevenly
    changed = false;
    for (int tet = 0; tet < mesh.tet_count(); ++tet) {
      const Eigen::VectorXd jacobians = node_jacobians(mesh, tet);
      if (jacobians.minCoeff() > kLeastJacobianRatio * jacobians.maxCoeff()) continue;
      for (int i = 4; i < 10; ++i) {
        const int node = mesh.tets(i, tet);
        if (!targets.col(node).allFinite() || straightened[static_cast<std::size_t>(node)]) continue;
        mesh.nodes.col(node) = straight.col(node);
        straightened[static_cast<std::size_t>(node)] = true;
        changed = true;
        ++count;
      }
    }
  }
  return count;
}

int curve_boundary(TetMesh& mesh, const RevolutionProfile& profile) {
  if (!mesh.quadratic()) return 0;
  Eigen::Matrix3Xd targets = straight_boundary(mesh);
  for (int node = mesh.corner_count; node < mesh.node_count(); ++node) {
    if (targets.col(node).allFinite()) targets.col(node) = profile.project(targets.col(node));
  }
  return bend_boundary(mesh, targets);
}

}  // namespace tissue_stiffness
