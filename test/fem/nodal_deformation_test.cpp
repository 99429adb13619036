#include "fem/nodal_deformation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "../box_model.hpp"

namespace tissue_stiffness {
namespace {

// Displacement that a deformation gradient brings about, the same everywhere.
Eigen::VectorXd affine(const TetMesh& mesh, const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3Xd moved = (gradient - Eigen::Matrix3d::Identity()) * mesh.nodes;
  return Eigen::Map<const Eigen::VectorXd>(moved.data(), moved.size());
}

TEST(NodalDeformation, IsThatOfAnAffineMotion) {
  const TetMesh mesh = bar_mesh(3);
  const Discretisation fem(mesh);
  const NodalDeformation deformation(fem);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  Eigen::Matrix3d stretch;
  stretch << 1.2, 0.1, 0.0, 0.1, 0.9, -0.05, 0.0, -0.05, 1.1;
  Eigen::Matrix3Xd found;
  deformation.find(affine(mesh, turn * stretch), found);
  ASSERT_EQ(found.cols(), 3 * mesh.node_count());
  for (int node = 0; node < mesh.node_count(); ++node)
    EXPECT_LT((found.middleCols<3>(3 * node) - turn * stretch).norm(), 1e-9) << "node " << node;
}

// A field that is no affine one: the mean over the elements around a node, weighted by their volumes.
TEST(NodalDeformation, IsTheMeanOverTheElementsAroundANode) {
  const TetMesh mesh = bar_mesh(4);
  const Discretisation fem(mesh);
  Eigen::VectorXd u(fem.dof_count());
  for (int node = 0; node < mesh.node_count(); ++node) {
    const double x = mesh.nodes(0, node), angle = 8.0 * x;  // bent about y
    u.segment<3>(3 * node) << -mesh.nodes(2, node) * std::sin(angle), 0.0, 3.0 * x * x;
  }
  Eigen::Matrix3Xd found;
  NodalDeformation(fem).find(u, found);
  std::vector<Eigen::Matrix3d> mean(static_cast<std::size_t>(mesh.node_count()), Eigen::Matrix3d::Zero());
  std::vector<double> volume(mean.size(), 0.0);
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < fem.points_per_element(); ++q) {
      Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
      for (int b = 0; b < fem.nodes_per_element(); ++b)
        f += u.segment<3>(3 * fem.elements()(b, e)) * fem.gradient(e, q).col(b).transpose();
      for (int a = 0; a < fem.nodes_per_element(); ++a) {
        mean[static_cast<std::size_t>(fem.elements()(a, e))] += fem.weight(e, q) * f;
        volume[static_cast<std::size_t>(fem.elements()(a, e))] += fem.weight(e, q);
      }
    }
  }
  for (std::size_t node = 0; node < mean.size(); ++node) {
    const Eigen::Matrix3d f = mean[node] / volume[node];
    EXPECT_LT((found.middleCols<3>(3 * static_cast<Eigen::Index>(node)) - f).norm(), 1e-9) << "node " << node;
  }
}

}  // namespace
}  // namespace tissue_stiffness
