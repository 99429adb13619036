#include "meshing/bend_boundary.hpp"

#include <algorithm>
#include <vector>

#include "meshing/quality.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastJacobianRatio = 0.1;  // an element bent more than this is straightened
constexpr double kStraighter = 0.8;          // what is left of its offsets each time
constexpr double kLeastShare = 0.1;          // of an offset: less is not worth an element's shape
constexpr int kMostSweeps = 20;              // of the smoothing
constexpr double kSettled = 1e-3;            // of the largest offset: a change by less ends the smoothing

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
    const double largest = offsets_.cwiseAbs().maxCoeff();
    for (int sweep = 0; sweep < kMostSweeps && smooth() > kSettled * largest;) ++sweep;
    return straight_ + offsets_;
  }

  // Makes the edges of an element straighter, and those inside straight. Returns whether one was bent.
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

 private:
  static constexpr double kFollows = -1.0;

  // Makes one sweep of Gauss and Seidel. Returns the largest change.
  double smooth() {
    double most = 0.0;
    for (Eigen::Index node = 0; node < offsets_.cols(); ++node) {
      const std::vector<int>& around = neighbours_[static_cast<std::size_t>(node)];
      if (share_[node] != kFollows || around.empty()) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const int other : around) sum += offsets_.col(other);
      const Eigen::Vector3d next = sum / static_cast<double>(around.size());
      most = std::max(most, (next - offsets_.col(node)).cwiseAbs().maxCoeff());
      offsets_.col(node) = next;
    }
    return most;
  }

  const Eigen::Matrix3Xd straight_;
  Eigen::Matrix3Xd offsets_;
  Eigen::VectorXd share_;                     ///< of a node's way to its target, or kFollows
  std::vector<std::vector<int>> neighbours_;  ///< of each mid-edge node, in all of its elements
};

}  // namespace

void bend_boundary(TetMesh& mesh, const Eigen::Matrix3Xd& targets) {
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
}

}  // namespace tissue_stiffness
