#include "meshing/quality.hpp"

#include <cmath>

#include "mesh_checks.hpp"
#include "meshing/box_mesh.hpp"
#include "meshing/elevate.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

TetMesh one_tet(const Eigen::Vector3d& apex) {
  TetMesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0.0, 1.0, 0.5, apex.x(), 0.0, 0.0, std::sqrt(0.75), apex.y(), 0.0, 0.0, 0.0, apex.z();
  mesh.tets = Eigen::Vector4i(0, 1, 2, 3);
  mesh.corner_count = 4;
  return mesh;
}

TEST(MeshQuality, OfARegularTetrahedronIsOne) {
  TetMesh mesh = one_tet({0.5, std::sqrt(0.75) / 3.0, std::sqrt(2.0 / 3.0)});
  elevate_to_quadratic(mesh);
  const MeshQuality quality = measure_quality(mesh);
  EXPECT_NEAR(quality.least_radius_ratio, 1.0, 1e-12);
  EXPECT_NEAR(quality.least_dihedral_angle, std::acos(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(quality.least_jacobian_ratio, 1.0, 1e-12);
  EXPECT_NEAR(quality.mean_edge_length, 1.0, 1e-12);
  EXPECT_NEAR(quality.volume, 1.0 / (6.0 * std::sqrt(2.0)), 1e-12);
  mesh.nodes.col(4) += Eigen::Vector3d(0.0, 0.1, 0.0);
  EXPECT_LT(measure_quality(mesh).least_jacobian_ratio, 0.95) << "a bent edge changes the Jacobian from place to place";
}

TEST(MeshQuality, OfAFlatTetrahedronIsSmall) {
  const MeshQuality quality = measure_quality(one_tet({0.5, 0.3, 1e-3}));
  EXPECT_LT(quality.least_radius_ratio, 0.01);
  EXPECT_LT(quality.least_dihedral_angle, 0.01);
}

TEST(MeshQuality, IsToldInOneLine) {
  const TetMesh mesh = make_box_mesh({0.1, 0.1, 0.1}, 1, 1, 1, 2);
  const std::string line = describe_quality(mesh, measure_quality(mesh));
  expect_contains(line, "6 10-node tetrahedra, 27 nodes");
  expect_contains(line, "least dihedral angle 45 deg");
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_THROW(measure_quality({}), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
