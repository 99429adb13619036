#include "meshing/offset_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <vector>

#include "meshing/quality.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFlat = 0.02;  // share of the largest eigenvalue: facets that fold by less stand for one smooth surface

struct Around {
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();  // sum a n n^T
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();     // sum a n
};

// Returns the smallest d with least square. What a curved surface's facets differ in is no direction of its own.
Eigen::Vector3d displacement(const Around& around) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(around.square);
  const double least = kFlat * eigen.eigenvalues()[2];
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!(eigen.eigenvalues()[k] > least)) continue;
    const Eigen::Vector3d along = eigen.eigenvectors().col(k);
    out += along.dot(around.sum) / eigen.eigenvalues()[k] * along;
  }
  return out;
}

}  // namespace

TetMesh offset_surface(const TetMesh& mesh, double outward) {
  std::vector<Around> around(static_cast<std::size_t>(mesh.corner_count));
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const Eigen::Vector3d area = facet_area_vector(mesh, f);
    for (int i = 0; i < 3; ++i) {
      Around& corner = around[static_cast<std::size_t>(mesh.facets(i, f))];
      corner.square += area * area.transpose() / area.norm();
      corner.sum += area;
    }
  }
  Eigen::Matrix3Xd moves = Eigen::Matrix3Xd::Zero(3, mesh.node_count());
  for (int corner = 0; corner < mesh.corner_count; ++corner) {
    if (around[static_cast<std::size_t>(corner)].square.trace() > 0.0)
      moves.col(corner) = outward * displacement(around[static_cast<std::size_t>(corner)]);
  }
  for (Eigen::Index t = 0; t < mesh.tets.cols() && mesh.quadratic(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const auto [a, b] = kTetEdges[static_cast<std::size_t>(e)];
      moves.col(mesh.tets(4 + e, t)) = 0.5 * (moves.col(mesh.tets(a, t)) + moves.col(mesh.tets(b, t)));
    }
  }
  TetMesh out = mesh;
  out.nodes += moves;
  return out;
}

double shortest_edge(const TetMesh& mesh) {
  double out = std::numeric_limits<double>::infinity();
  for (int t = 0; t < mesh.tet_count(); ++t) out = std::min(out, edge_lengths(mesh, t).minCoeff());
  return out;
}

}  // namespace tissue_stiffness
