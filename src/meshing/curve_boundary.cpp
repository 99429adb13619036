#include <limits>
#include <vector>

#include "meshing/bend_boundary.hpp"
#include "meshing/bodies.hpp"
#include "meshing/quality.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastJacobianRatio = 0.1;  // an element bent more than this is straightened
constexpr double kStraighter = 0.8;          // what is left of its offsets each time
constexpr double kLeastShare = 0.1;          // of an offset: less is not worth an element's shape
constexpr int kSweeps = 20;                  // of the smoothing, whose offsets fall off within few elements

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

/// How far the mid-edge nodes of a mesh are from the middles of its straight edges. The edges inside follow the boundary:
/// each of their middles moves by the mean of its neighbours' offsets (Laplacian smoothing). Corners do not move.
class BentEdges {
 public:
  BentEdges(const TetMesh& mesh, const Eigen::Matrix3Xd& targets)
      : straight_(mesh.nodes),
        offsets_(Eigen::Matrix3Xd::Zero(3, mesh.node_count())),
        share_(Eigen::VectorXd::Constant(mesh.node_count(), kFollows)),
        neighbours_(static_cast<std::size_t>(mesh.node_count())) {
    for (int node = mesh.corner_count; node < mesh.node_count(); ++node) {
      if (!targets.col(node).allFinite()) continue;
      offsets_.col(node) = targets.col(node) - straight_.col(node);
      share_[node] = 1.0;
    }
    for (int tet = 0; tet < mesh.tet_count(); ++tet) {
      for (int i = 4; i < 10; ++i) {
        for (int k = 0; k < 10; ++k) {
          if (k != i) neighbours_[static_cast<std::size_t>(mesh.tets(i, tet))].push_back(mesh.tets(k, tet));
        }
      }
    }
  }

  Eigen::Matrix3Xd nodes() {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (Eigen::Index node = 0; node < offsets_.cols(); ++node) {
        const std::vector<int>& around = neighbours_[static_cast<std::size_t>(node)];
        if (share_[node] != kFollows || around.empty()) continue;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const int other : around) sum += offsets_.col(other);
        offsets_.col(node) = sum / static_cast<double>(around.size());
      }
    }
    return straight_ + offsets_;
  }

  // Makes the edges of an element straighter. Returns whether one was bent.
  bool straighten(const TetMesh& mesh, int tet) {
    bool changed = false;
    for (int i = 4; i < 10; ++i) {
      const int node = mesh.tets(i, tet);
      if (share_[node] == 0.0) continue;
      const double less = share_[node] > kLeastShare ? kStraighter : 0.0;
      share_[node] = share_[node] == kFollows ? 0.0 : less * share_[node];
      offsets_.col(node) *= less;
      changed = true;
    }
    return changed;
  }

  // Returns the number of nodes that do not reach their targets.
  int put_back() const { return static_cast<int>((share_.array() >= 0.0 && share_.array() < 1.0).count()); }

 private:
  static constexpr double kFollows = -1.0;

  const Eigen::Matrix3Xd straight_;
  Eigen::Matrix3Xd offsets_;
  Eigen::VectorXd share_;                     ///< of a node's way to its target, or kFollows
  std::vector<std::vector<int>> neighbours_;  ///< of each mid-edge node, in all of its elements
};

}  // namespace

int bend_boundary(TetMesh& mesh, const Eigen::Matrix3Xd& targets) {
  BentEdges edges(mesh, targets);
  for (bool changed = true; changed;) {  // straightening one element bends its neighbours less, but unevenly
    changed = false;
    mesh.nodes = edges.nodes();
    for (int tet = 0; tet < mesh.tet_count(); ++tet) {
      const Eigen::VectorXd jacobians = node_jacobians(mesh, tet);
      if (jacobians.minCoeff() > kLeastJacobianRatio * jacobians.maxCoeff()) continue;
      changed = edges.straighten(mesh, tet) || changed;
    }
  }
  return edges.put_back();
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
