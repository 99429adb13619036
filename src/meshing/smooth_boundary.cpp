#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "meshing/bend_boundary.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSmooth = 0.766;   // cosine of 40 degrees
constexpr double kStraight = 1e-6;  // of an edge's length: distance from its middle that is rounding

struct Edge {
  int middle = 0;
  std::vector<int> facets;
};

std::map<std::pair<int, int>, Edge> boundary_edges(const TetMesh& mesh) {
  std::map<std::pair<int, int>, Edge> edges;
  for (int f = 0; f < mesh.facet_count(); ++f) {
    for (int side = 0; side < 3; ++side) {
      Edge& edge = edges[std::minmax({mesh.facets(side, f), mesh.facets((side + 1) % 3, f)})];
      edge.middle = mesh.facets(3 + side, f);
      edge.facets.push_back(f);
    }
  }
  return edges;
}

}  // namespace

void smooth_boundary(TetMesh& mesh) {
  if (!mesh.quadratic()) return;
  Eigen::Matrix3Xd normals(3, mesh.facet_count());  // times twice the area
  std::vector<std::vector<int>> around(static_cast<std::size_t>(mesh.corner_count));
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const auto x = [&](int i) { return mesh.nodes.col(mesh.facets(i, f)); };
    normals.col(f) = Eigen::Vector3d(x(1) - x(0)).cross(Eigen::Vector3d(x(2) - x(0)));
    for (int i = 0; i < 3; ++i) around[static_cast<std::size_t>(mesh.facets(i, f))].push_back(f);
  }
  // Returns the normal at a corner, averaged over the facets whose normals are within 40 degrees of `side`.
  const auto normal_at = [&](int node, const Eigen::Vector3d& side) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int f : around[static_cast<std::size_t>(node)]) {
      if (normals.col(f).normalized().dot(side) > kSmooth) sum += normals.col(f);
    }
    return Eigen::Vector3d(sum.normalized());
  };
  Eigen::Matrix3Xd targets = Eigen::Matrix3Xd::Constant(3, mesh.node_count(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& [ends, edge] : boundary_edges(mesh)) {
    if (edge.facets.size() != 2) continue;
    const Eigen::Vector3d n0 = normals.col(edge.facets[0]).normalized(), n1 = normals.col(edge.facets[1]).normalized();
    const Eigen::Vector3d a = mesh.nodes.col(ends.first), b = mesh.nodes.col(ends.second), along = b - a;
    if ((mesh.nodes.col(edge.middle) - 0.5 * (a + b)).norm() > kStraight * along.norm()) return;  // curved already
    if (n0.dot(n1) < kSmooth) continue;
    const Eigen::Vector3d side = (n0 + n1).normalized();
    const Eigen::Vector3d na = normal_at(ends.first, side), nb = normal_at(ends.second, side);
    targets.col(edge.middle) = 0.5 * (a + b) + 0.125 * (along.dot(nb) * nb - along.dot(na) * na);
  }
  bend_boundary(mesh, targets);
}

}  // namespace tissue_stiffness
