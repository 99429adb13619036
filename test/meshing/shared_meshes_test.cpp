#include <gtest/gtest.h>

#include <fstream>

#include "meshing/surface.hpp"
#include "meshing/tetgen_mesher.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"

namespace tissue_stiffness {
namespace {

struct SharedMesh {
  std::string file;
  int corners, tets;
};

class SharedMeshes : public testing::TestWithParam<SharedMesh> {};

TEST_P(SharedMeshes, LoadWithTheirOwnNumbersAndClosedSurface) {
  MeshSettings settings;
  settings.file = std::string(TISSUE_STIFFNESS_SHARED) + "/" + GetParam().file;
  if (!std::ifstream(settings.file)) GTEST_SKIP() << settings.file << " is not there";
  const TetMesh mesh = build_mesh(settings);
  EXPECT_EQ(mesh.corner_count, GetParam().corners);
  EXPECT_EQ(mesh.tet_count(), GetParam().tets);
  EXPECT_TRUE(mesh.quadratic());
  double volume = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int f = 0; f < mesh.facet_count(); ++f) {
    sum += facet_area_vector(mesh, f);
    volume += facet_area_vector(mesh, f).dot(mesh.nodes.col(mesh.facets(0, f))) / 3.0;
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_NEAR(volume, mesh_volume(mesh), 1e-12 * volume);
}

INSTANTIATE_TEST_SUITE_P(Shared, SharedMeshes,
                         testing::Values(SharedMesh{"cases/case_01/mesh.vtk", 345, 1017},
                                         SharedMesh{"cases/case_06/mesh.vtk", 913, 2728},
                                         SharedMesh{"cases/case_09/mesh.vtk", 784, 2982},
                                         SharedMesh{"recordings/bar_release/mesh.vtk", 345, 1017}));

TEST(SharedMeshRegions, CavityOfTheVentricleIsACapOfItsWall) {
  MeshSettings settings;
  settings.file = std::string(TISSUE_STIFFNESS_SHARED) + "/cases/case_06/mesh.vtk";
  if (!std::ifstream(settings.file)) GTEST_SKIP() << settings.file << " is not there";
  const TetMesh mesh = build_mesh(settings);
  const auto regions = resolve_regions(
      {{"clamp", BoxShape{{-1, -1, 0.019999}, {1, 1, 1}}}, {"cavity", EllipsoidShape{{0, 0, 0}, {0.0203, 0.0203, 0.0503}}}},
      mesh);
  EXPECT_GT(regions.at("clamp").facets.size(), 20u);
  EXPECT_GT(regions.at("cavity").facets.size(), 100u);
  for (const int f : regions.at("cavity").facets) {
    const Eigen::Vector3d normal = facet_area_vector(mesh, f);
    Eigen::Vector3d towards_axis = -mesh.nodes.col(mesh.facets(0, f));
    if (std::abs(towards_axis.z()) < 0.04) towards_axis.z() = 0.0;
    EXPECT_GT(normal.dot(towards_axis), 0.0) << "facet " << f << " of the cavity points out of the wall into the cavity";
  }
}

TEST(SiliconeBeam, FineSurfaceGivesMeshOfTheSizeAskedFor) {
  if (!has_tetgen()) GTEST_SKIP() << "this build is without TetGen";
  MeshSettings settings;
  settings.file = std::string(TISSUE_STIFFNESS_SHARED) + "/cases/silicone_beam_gravity_a/beam.stl";
  if (!std::ifstream(settings.file)) GTEST_SKIP() << settings.file << " is not there";
  settings.scale = 0.001;
  settings.max_edge_length = 0.01;
  const TetMesh mesh = build_mesh(settings);
  EXPECT_GT(mesh.tet_count(), 300);
  EXPECT_LT(mesh.tet_count(), 2500);
  EXPECT_NEAR(mesh_volume(mesh), 9e-5, 1e-15);
  EXPECT_TRUE(mesh.nodes.rowwise().minCoeff().isZero(1e-12));
  EXPECT_TRUE(mesh.nodes.rowwise().maxCoeff().isApprox(Eigen::Vector3d(0.03, 0.03, 0.1), 1e-9));
  const auto regions = resolve_regions({{"clamp", BoxShape{{-1, -1, -1e-6}, {1, 1, 1e-6}}}}, mesh);
  double area = 0.0;
  for (const int f : regions.at("clamp").facets) area += facet_area_vector(mesh, f).norm();
  EXPECT_NEAR(area, 9e-4, 1e-12);
}

}  // namespace
}  // namespace tissue_stiffness
