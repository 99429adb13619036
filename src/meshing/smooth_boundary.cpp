#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "meshing/bend_boundary.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSmooth = 0.5;     // cosine of 60 degrees: a ring of seven corners or more passes for a circle
constexpr double kSameSide = 0.9;   // cosine between the sides of a sharp edge, above which they give no direction
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

/// Normals of the smooth surface through a mesh's boundary corners.
class CornerNormals {
 public:
  explicit CornerNormals(const TetMesh& mesh)
      : normals_(3, mesh.facet_count()), corners_(static_cast<std::size_t>(mesh.corner_count)) {
    for (int f = 0; f < mesh.facet_count(); ++f) {
      const auto x = [&](int i) { return mesh.nodes.col(mesh.facets(i % 3, f)); };
      normals_.col(f) = Eigen::Vector3d(x(1) - x(0)).cross(Eigen::Vector3d(x(2) - x(0))).normalized();
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d next = (x(i + 1) - x(i)).normalized(), last = (x(i + 2) - x(i)).normalized();
        corners_[static_cast<std::size_t>(mesh.facets(i, f))].push_back(
            {f, std::acos(std::clamp(next.dot(last), -1.0, 1.0))});
      }
    }
  }

  Eigen::Vector3d of_facet(int facet) const { return normals_.col(facet); }

  // Returns the mean normal of the facets around a corner that fold little against `side`, weighted by their angles there
  // (Thuermer & Wuethrich 1998), so that it does not depend on how a surface is cut into triangles.
  Eigen::Vector3d at(int node, const Eigen::Vector3d& side) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Corner& corner : corners_[static_cast<std::size_t>(node)]) {
      if (normals_.col(corner.facet).dot(side) > kSmooth) sum += corner.angle * normals_.col(corner.facet);
    }
    return sum.normalized();
  }

 private:
  struct Corner {
    int facet;
    double angle;
  };
  Eigen::Matrix3Xd normals_;
  std::vector<std::vector<Corner>> corners_;
};

/// How far a smooth surface through both ends of an edge is from the edge's middle.
struct Bulge {
  Eigen::Vector3d normal, offset;
};

// Returns that of the edge of a PN triangle.
Bulge bulge(const CornerNormals& normals, const TetMesh& mesh, const std::pair<int, int>& ends,
            const Eigen::Vector3d& side) {
  const Eigen::Vector3d along = mesh.nodes.col(ends.second) - mesh.nodes.col(ends.first);
  const Eigen::Vector3d a = normals.at(ends.first, side), b = normals.at(ends.second, side);
  return {(a + b).normalized(), 0.125 * (along.dot(b) * b - along.dot(a) * a)};
}

// Two surfaces meet at a sharp edge. Returns the least offset that is on both.
Eigen::Vector3d common_offset(const Bulge& one, const Bulge& other) {
  const double cosine = one.normal.dot(other.normal);
  if (std::abs(cosine) > kSameSide) return Eigen::Vector3d::Zero();
  Eigen::Matrix2d gram;
  gram << 1.0, cosine, cosine, 1.0;
  const Eigen::Vector2d share =
      gram.inverse() * Eigen::Vector2d(one.normal.dot(one.offset), other.normal.dot(other.offset));
  return share[0] * one.normal + share[1] * other.normal;
}

}  // namespace

void smooth_boundary(TetMesh& mesh) {
  if (!mesh.quadratic()) return;
  const CornerNormals normals(mesh);
  Eigen::Matrix3Xd targets = Eigen::Matrix3Xd::Constant(3, mesh.node_count(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& [ends, edge] : boundary_edges(mesh)) {
    if (edge.facets.size() != 2) continue;
    const Eigen::Vector3d a = mesh.nodes.col(ends.first), b = mesh.nodes.col(ends.second), middle = 0.5 * (a + b);
    if ((mesh.nodes.col(edge.middle) - middle).norm() > kStraight * (b - a).norm()) return;  // curved already
    const Eigen::Vector3d one = normals.of_facet(edge.facets[0]), other = normals.of_facet(edge.facets[1]);
    const auto of_side = [&, &ends = ends](const Eigen::Vector3d& side) { return bulge(normals, mesh, ends, side); };
    targets.col(edge.middle) = middle + (one.dot(other) > kSmooth ? of_side((one + other).normalized()).offset
                                                                  : common_offset(of_side(one), of_side(other)));
  }
  bend_boundary(mesh, targets);
}

TetMesh smooth_unless_faceted(const MeshSettings& settings, TetMesh mesh) {
  if (!settings.faceted) smooth_boundary(mesh);
  return mesh;
}

}  // namespace tissue_stiffness
