#include "meshing/box_mesh.hpp"

#include <gtest/gtest.h>

#include "meshing/elevate.hpp"
#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

TEST(BoxMesh, FillsTheBoxWithPositiveTetrahedra) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = make_box_mesh({0.1, 0.02, 0.03}, 5, 2, 3, order, {-1.0, 2.0, 3.0});
    EXPECT_EQ(mesh.tet_count(), 6 * 5 * 2 * 3);
    EXPECT_EQ(mesh.corner_count, 6 * 3 * 4);
    EXPECT_EQ(mesh.quadratic(), order == 2);
    EXPECT_NEAR(mesh_volume(mesh), 0.1 * 0.02 * 0.03, 1e-17);
    for (int tet = 0; tet < mesh.tet_count(); ++tet) EXPECT_GT(tet_volume(mesh, tet), 0.0);
    EXPECT_TRUE(mesh.nodes.rowwise().minCoeff().isApprox(Eigen::Vector3d(-1.0, 2.0, 3.0)));
    EXPECT_TRUE(mesh.nodes.rowwise().maxCoeff().isApprox(Eigen::Vector3d(-0.9, 2.02, 3.03)));
  }
}

TEST(BoxMesh, FacetsCloseAndPointOutwards) {
  const TetMesh mesh = make_box_mesh({1.0, 2.0, 3.0}, 2, 3, 2, 2);
  EXPECT_EQ(mesh.facet_count(), 2 * 2 * (2 * 3 + 3 * 2 + 2 * 2));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double volume = 0.0;
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const Eigen::Vector3d normal = facet_area_vector(mesh, f);
    sum += normal;
    volume += normal.dot(mesh.nodes.col(mesh.facets(0, f))) / 3.0;
    const Eigen::Vector3d centre =
        mesh.nodes.col(mesh.tets(0, mesh.facet_tet[f])) + mesh.nodes.col(mesh.tets(1, mesh.facet_tet[f])) +
        mesh.nodes.col(mesh.tets(2, mesh.facet_tet[f])) + mesh.nodes.col(mesh.tets(3, mesh.facet_tet[f]));
    EXPECT_GT(normal.dot(mesh.nodes.col(mesh.facets(0, f)) - 0.25 * centre), 0.0);
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_NEAR(volume, 6.0, 1e-12);
}

TEST(Elevate, PutsSharedNodesInTheMiddleOfEdges) {
  TetMesh mesh = make_box_mesh({1.0, 1.0, 1.0}, 1, 1, 1, 1);
  const TetMesh linear = mesh;
  elevate_to_quadratic(mesh);
  EXPECT_EQ(mesh.node_count(), 8 + 19);  // a Kuhn cube has 12 + 6 + 1 edges
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    for (int edge = 0; edge < 6; ++edge) {
      const auto& ends = kTetEdges[static_cast<std::size_t>(edge)];
      const Eigen::Vector3d middle =
          0.5 * (mesh.nodes.col(mesh.tets(ends[0], tet)) + mesh.nodes.col(mesh.tets(ends[1], tet)));
      EXPECT_EQ(middle, mesh.nodes.col(mesh.tets(4 + edge, tet)));
    }
  }
  for (int f = 0; f < mesh.facet_count(); ++f) {
    for (int side = 0; side < 3; ++side) {
      const Eigen::Vector3d middle =
          0.5 * (mesh.nodes.col(mesh.facets(side, f)) + mesh.nodes.col(mesh.facets((side + 1) % 3, f)));
      EXPECT_EQ(middle, mesh.nodes.col(mesh.facets(3 + side, f)));
    }
  }
  drop_mid_nodes(mesh);
  EXPECT_EQ(mesh.tets, linear.tets);
  EXPECT_EQ(mesh.facets, linear.facets);
  EXPECT_EQ(mesh.nodes, linear.nodes);
}

TEST(BoxMesh, RefusesBadArguments) {
  EXPECT_THROW(make_box_mesh({1.0, 0.0, 1.0}, 1, 1, 1), InputError);
  EXPECT_THROW(make_box_mesh({1.0, 1.0, 1.0}, 1, 0, 1), InputError);
  EXPECT_THROW(make_box_mesh({1.0, 1.0, 1.0}, 1, 1, 1, 3), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
