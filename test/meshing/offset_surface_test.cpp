#include "meshing/offset_surface.hpp"

#include <gtest/gtest.h>

#include "meshing/box_mesh.hpp"
#include "meshing/quality.hpp"
#include "meshing/surface.hpp"
#include "tube_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kOutward = 1e-3;

// A box keeps its edges and corners, and every facet moves by the distance that is asked for.
TEST(OffsetSurface, EnlargesABoxOnAllSides) {
  for (const double outward : {kOutward, -kOutward}) {
    const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.03}, 5, 2, 3, 2), out = offset_surface(mesh, outward);
    const Eigen::Vector3d least = mesh.nodes.rowwise().minCoeff(), most = mesh.nodes.rowwise().maxCoeff();
    EXPECT_TRUE(out.nodes.rowwise().minCoeff().isApprox(Eigen::Vector3d(least.array() - outward), 1e-9));
    EXPECT_TRUE(out.nodes.rowwise().maxCoeff().isApprox(Eigen::Vector3d(most.array() + outward), 1e-9));
    const Eigen::Array3d size = (most - least).array() + 2.0 * outward;
    EXPECT_NEAR(mesh_volume(out) / size.prod(), 1.0, 1e-9);
    for (int t = 0; t < out.tet_count(); ++t) EXPECT_GT(node_jacobians(out, t).minCoeff(), 0.0);
  }
}

// The wall of a tube becomes thicker on both sides, and its ends move along its axis.
TEST(OffsetSurface, ThickensTheWallOfATube) {
  constexpr double kInner = 0.010, kOuter = 0.016, kLength = 0.03;
  constexpr int kSides = 24;
  const TetMesh out = offset_surface(tube_mesh(kInner, kOuter, kLength, kSides, 2, 4), kOutward);
  const Eigen::VectorXd radius = out.nodes.leftCols(out.corner_count).topRows(2).colwise().norm().transpose();
  EXPECT_NEAR(radius.minCoeff(), kInner - kOutward, 0.02 * kOutward);
  EXPECT_NEAR(radius.maxCoeff(), kOuter + kOutward, 0.02 * kOutward);
  EXPECT_NEAR(out.nodes.row(2).minCoeff(), -kOutward, 1e-9);
  EXPECT_NEAR(out.nodes.row(2).maxCoeff(), kLength + kOutward, 1e-9);
}

// Mid-edge nodes stay where a curved surface has them, as far as their edge does not move.
TEST(OffsetSurface, MovesMidNodesWithTheirEdges) {
  TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  const int mid = mesh.facets(3, 0);
  mesh.nodes.col(mid) += 2e-4 * facet_area_vector(mesh, 0).normalized();
  const TetMesh straight = offset_surface(make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2), kOutward);
  const TetMesh curved = offset_surface(mesh, kOutward);
  const Eigen::Vector3d left = curved.nodes.col(mid) - straight.nodes.col(mid);
  EXPECT_NEAR((left - 2e-4 * facet_area_vector(mesh, 0).normalized()).norm(), 0.0, 1e-12);
}

TEST(OffsetSurface, FindsTheShortestEdge) {
  EXPECT_NEAR(shortest_edge(make_box_mesh({0.10, 0.02, 0.03}, 5, 4, 2, 1)), 0.005, 1e-12);
}

}  // namespace
}  // namespace tissue_stiffness
