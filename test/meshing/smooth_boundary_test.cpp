#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshing/bend_boundary.hpp"
#include "meshing/box_mesh.hpp"
#include "meshing/elevate.hpp"
#include "meshing/quality.hpp"
#include "meshing/surface.hpp"
#include "tube_mesh.hpp"

namespace tissue_stiffness {
namespace {

// A cube blown up to the unit ball, flat facets between its corners.
TetMesh faceted_ball(int cells) {
  TetMesh mesh = make_box_mesh({2.0, 2.0, 2.0}, cells, cells, cells, 1);
  const Eigen::Vector3d centre = 0.5 * (mesh.nodes.rowwise().minCoeff() + mesh.nodes.rowwise().maxCoeff());
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i) - centre;
    const double reach = x.cwiseAbs().maxCoeff();
    mesh.nodes.col(i) = reach > 0.0 ? Eigen::Vector3d(x.normalized() * reach) : x;
  }
  elevate_to_quadratic(mesh);
  return mesh;
}

double mean_distance_from_sphere(const TetMesh& mesh) {
  double sum = 0.0;
  for (int f = 0; f < mesh.facet_count(); ++f) {
    for (int i = 3; i < 6; ++i) sum += std::abs(mesh.nodes.col(mesh.facets(i, f)).norm() - 1.0);
  }
  return sum / (3 * mesh.facet_count());
}

TEST(SmoothBoundary, FindsTheBallBehindFlatFacets) {
  const TetMesh flat = faceted_ball(6);
  TetMesh smooth = flat;
  smooth_boundary(smooth);
  EXPECT_LT(mean_distance_from_sphere(smooth), 0.35 * mean_distance_from_sphere(flat));
  EXPECT_EQ(smooth.nodes.leftCols(flat.corner_count), flat.nodes.leftCols(flat.corner_count));
  for (int t = 0; t < smooth.tet_count(); ++t) EXPECT_GT(node_jacobians(smooth, t).minCoeff(), 0.0);
}

// Sides that fold by 45 degrees are round, and so are the rims between them and the flat ends.
TEST(SmoothBoundary, FindsTheTubeBehindEightSides) {
  const TetMesh flat = tube_mesh(1.0, 1.75, 2.0, 8, 2, 2);
  TetMesh smooth = flat;
  smooth_boundary(smooth);
  double most = 0.0, before = 0.0;
  for (int f = 0; f < smooth.facet_count(); ++f) {
    for (int side = 0; side < 3; ++side) {
      const int node = smooth.facets(3 + side, f);
      const auto radius = [f](const TetMesh& mesh, int i) { return mesh.nodes.col(mesh.facets(i, f)).head<2>().norm(); };
      const double at_ends = radius(flat, side);
      EXPECT_NEAR(smooth.nodes(2, node), flat.nodes(2, node), 1e-12);
      const bool on_tube = std::abs(at_ends - 1.0) < 1e-9 || std::abs(at_ends - 1.75) < 1e-9;
      if (!on_tube || std::abs(radius(flat, (side + 1) % 3) - at_ends) > 1e-9) continue;
      most = std::max(most, std::abs(radius(smooth, 3 + side) / at_ends - 1.0));
      before = std::max(before, std::abs(radius(flat, 3 + side) / at_ends - 1.0));
    }
  }
  EXPECT_NEAR(before, 1.0 - std::cos(M_PI / 8.0), 1e-9);
  EXPECT_LT(most, 0.5 * before);
  for (int t = 0; t < smooth.tet_count(); ++t) EXPECT_GT(node_jacobians(smooth, t).minCoeff(), 0.0);
}

TEST(SmoothBoundary, LeavesABoxAndACurvedMeshAlone) {
  TetMesh box = make_box_mesh({0.1, 0.02, 0.03}, 3, 2, 2, 2);
  const TetMesh before = box;
  smooth_boundary(box);
  EXPECT_LT((box.nodes - before.nodes).cwiseAbs().maxCoeff(), 1e-15);
  TetMesh ball = faceted_ball(4);
  smooth_boundary(ball);
  const TetMesh once = ball;
  smooth_boundary(ball);
  EXPECT_EQ(ball.nodes, once.nodes);
}

}  // namespace
}  // namespace tissue_stiffness
