// Linear fields and rigid motions: what every element must get right to round-off.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "elastic_body.hpp"

namespace tissue_stiffness {
namespace {

using Law = ElasticBody::Law;

const Eigen::Vector3d kSize(0.10, 0.08, 0.06);
const Lame kLame = lame(20e3, 0.45);

// Largest error of the inner nodes, over the size of the field, when the boundary follows u = (F - 1) X.
double patch_error(int order, Law law, const Eigen::Matrix3d& stretch) {
  const TetMesh mesh = distorted_box(kSize, 3, order);
  const ElasticBody body(mesh, law, kLame, 1000.0, boundary_dofs(mesh));
  const Eigen::VectorXd exact =
      nodal(mesh, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return (stretch - Eigen::Matrix3d::Identity()) * x; });
  // Newton starts beside the solution: finding it is part of the test.
  const Eigen::VectorXd start = exact + random_vector(exact.size(), 1e-3, 3);
  return (equilibrium(body, exact, start) - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

TEST(Patch, LinearElasticityReproducesALinearField) {
  Eigen::Matrix3d stretch;
  stretch << 1.02, 0.03, -0.01, 0.005, 0.97, 0.02, -0.015, 0.01, 1.04;
  for (const int order : {1, 2}) {
    const double error = patch_error(order, Law::linear, stretch);
    std::printf("patch, linear, order %d: %.1e\n", order, error);
    EXPECT_LT(error, 1e-12);
  }
}

TEST(Patch, NeoHookeanReproducesSmallAndLargeStretch) {
  Eigen::Matrix3d small, large;
  small << 1.002, 0.003, -0.001, 0.0005, 0.997, 0.002, -0.0015, 0.001, 1.004;
  large << 1.6, 0.3, -0.1, 0.2, 0.75, 0.1, -0.2, 0.1, 1.1;
  for (const int order : {1, 2}) {
    for (const Eigen::Matrix3d& stretch : {small, large}) {
      const double error = patch_error(order, Law::neo_hookean, stretch);
      std::printf("patch, neo-Hookean, order %d, F_xx = %.3f: %.1e\n", order, stretch(0, 0), error);
      EXPECT_LT(error, 1e-11);
    }
  }
}

// Force at displacement u over the largest product that its sums are made of.
double relative_force(const ElasticBody& body, const Eigen::VectorXd& u) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.size());
  const double scale = (body.stiffness(0.0, rest, rest).cwiseAbs() * u.cwiseAbs()).maxCoeff();
  return body.force(0.0, u, rest).cwiseAbs().maxCoeff() / scale;
}

TEST(RigidMotion, LinearElasticityFeelsNoTranslationNorSmallRotation) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = distorted_box(kSize, 3, order);
    const ElasticBody body(mesh, Law::linear, kLame, 1000.0, boundary_dofs(mesh));
    const Eigen::VectorXd translation = nodal(mesh, [](const Eigen::Vector3d&) -> Eigen::Vector3d {
      return {0.3, -0.2, 0.7};
    });
    const Eigen::VectorXd rotation =
        nodal(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return Eigen::Vector3d(0.4, -0.9, 0.2).cross(x); });
    EXPECT_LT(relative_force(body, translation), 1e-13);
    EXPECT_LT(relative_force(body, rotation), 1e-13);
  }
}

TEST(RigidMotion, NeoHookeanFeelsNoFiniteRotation) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  for (const int order : {1, 2}) {
    const TetMesh mesh = distorted_box(kSize, 3, order);
    const ElasticBody body(mesh, Law::neo_hookean, kLame, 1000.0, boundary_dofs(mesh));
    const Eigen::VectorXd u = nodal(mesh, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return (turn - Eigen::Matrix3d::Identity()) * x + Eigen::Vector3d(0.02, 0.05, -0.01);
    });
    EXPECT_LT(relative_force(body, u), 1e-13);
    const double volume = kSize.prod();
    EXPECT_LT(std::abs(body.energy(u, Eigen::VectorXd::Zero(u.size()))), 1e-13 * kLame.mu * volume);
  }
}

}  // namespace
}  // namespace tissue_stiffness
