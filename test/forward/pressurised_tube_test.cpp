// A tube of few flat sides, against Lame's thick-walled cylinder.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "../box_model.hpp"
#include "../meshing/tube_mesh.hpp"
#include "fem/facet_quadrature.hpp"
#include "forward/model.hpp"
#include "forward/static_response.hpp"
#include "meshing/bend_boundary.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kInner = 0.06, kOuter = 0.105, kLength = 0.15, kModulus = 2.0e4, kPoisson = 0.45, kPressure = 1000.0;

bool on_circle(const TetMesh& mesh, int node, double radius) {
  return std::abs(mesh.nodes.col(node).head<2>().norm() - radius) < 1e-9;
}

// Returns the forces of the pressure on the inner side.
Eigen::VectorXd pressed(const TetMesh& mesh) {
  const FacetQuadrature quadrature(6);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(3 * mesh.node_count());
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const auto inner = [&](int i) { return on_circle(mesh, mesh.facets(i, f), kInner); };
    if (!inner(0) || !inner(1) || !inner(2)) continue;
    const FacetNodes x = facet_nodes(mesh, f);
    for (int q = 0; q < quadrature.points(); ++q) {
      const Eigen::Vector3d force = -kPressure * quadrature.weight(q) * quadrature.normal(x, q);
      for (int a = 0; a < 6; ++a) out.segment<3>(3 * mesh.facets(a, f)) += quadrature.shape(q)[a] * force;
    }
  }
  return out;
}

// Returns by how much the inner side's corners move outwards while the ends keep their distance, over Lame's solution.
double compliance(const TetMesh& mesh) {
  const Model model(
      box_settings({"inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: 2.0e4, poisson_ratio: 0.45}"}),
      mesh);
  const Eigen::VectorXd theta = model.prior_theta();
  std::vector<char> held(static_cast<std::size_t>(3 * mesh.node_count()), 0);
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i);
    const auto hold = [&](int axis) { held[static_cast<std::size_t>(3 * i + axis)] = 1; };
    if (std::abs(x[0]) < 1e-9) hold(0);
    if (std::abs(x[1]) < 1e-9) hold(1);
    if (x[2] < 1e-9 || x[2] > kLength - 1e-9) hold(2);
  }
  const StaticResponse response(model.rest_stiffness(theta), model.mass(theta), held, nullptr);
  const Eigen::VectorXd u = response(pressed(mesh));
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < mesh.corner_count; ++i) {
    if (!on_circle(mesh, i, kInner)) continue;
    sum += u.segment<2>(3 * i).dot(mesh.nodes.col(i).head<2>()) / kInner;
    ++count;
  }
  const double square = kInner * kInner;
  const double exact = (1.0 + kPoisson) / kModulus * kPressure * square / (kOuter * kOuter - square) *
                       ((1.0 - 2.0 * kPoisson) * kInner + kOuter * kOuter / kInner);
  return sum / count / exact;
}

TEST(PressurisedTube, IsAsStiffAsTheRoundOneBehindItsSides) {
  const TetMesh flat = tube_mesh(kInner, kOuter, kLength, 8, 2, 3);
  TetMesh smooth = flat;
  smooth_boundary(smooth);
  const double of_flat = compliance(flat), of_smooth = compliance(smooth);
  std::printf("eight flat sides: compliance %.4f, bent: %.4f of the closed form\n", of_flat, of_smooth);
  EXPECT_GT(std::abs(of_flat - 1.0), 0.05);
  EXPECT_NEAR(of_smooth, 1.0, 0.015);
}

}  // namespace
}  // namespace tissue_stiffness
