// Order of convergence under mesh refinement, against a manufactured solution.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "elastic_body.hpp"

namespace tissue_stiffness {
namespace {

const Lame kLame = lame(1.0, 0.3);
constexpr double kWave = 2.0;  // of the manufactured solution on the unit cube

// u = (sin kx cos ky, cos ky sin kz, sin kx sin kz)
Eigen::Vector3d exact(const Eigen::Vector3d& p) {
  const double x = kWave * p.x(), y = kWave * p.y(), z = kWave * p.z();
  return {std::sin(x) * std::cos(y), std::cos(y) * std::sin(z), std::sin(x) * std::sin(z)};
}

// -div sigma = -(lambda + mu) grad div u - mu laplace u
Eigen::Vector3d body_force(const Eigen::Vector3d& p) {
  const double x = kWave * p.x(), y = kWave * p.y(), z = kWave * p.z(), k2 = kWave * kWave;
  // div u = k (cos x cos y - sin y sin z + sin x cos z)
  const Eigen::Vector3d grad_div = k2 * Eigen::Vector3d(-std::sin(x) * std::cos(y) + std::cos(x) * std::cos(z),
                                                        -std::cos(x) * std::sin(y) - std::cos(y) * std::sin(z),
                                                        -std::sin(y) * std::cos(z) - std::sin(x) * std::sin(z));
  return -(kLame.lambda + kLame.mu) * grad_div + 2.0 * k2 * kLame.mu * exact(p);
}

// Gauss-Legendre points of three variables folded into the unit tetrahedron (Duffy), degree 5.
std::vector<std::pair<Eigen::Vector3d, double>> fine_rule() {
  const std::array<double, 4> at{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  const std::array<double, 4> weight{0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
  std::vector<std::pair<Eigen::Vector3d, double>> rule;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double r = at[i], s = (1.0 - r) * at[j], t = (1.0 - r - s) * at[k];
        rule.push_back({{r, s, t}, weight[i] * weight[j] * weight[k] * (1.0 - r) * (1.0 - r - s)});
      }
    }
  }
  return rule;
}

double l2_error(const TetMesh& mesh, const Eigen::VectorXd& u) {
  const auto rule = fine_rule();
  const auto n = mesh.tets.rows();
  double sum = 0.0;
  for (Eigen::Index e = 0; e < mesh.tets.cols(); ++e) {
    Eigen::Matrix3Xd x(3, n), d(3, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      x.col(a) = mesh.nodes.col(mesh.tets(a, e));
      d.col(a) = u.segment<3>(3 * mesh.tets(a, e));
    }
    for (const auto& [place, weight] : rule) {
      const Eigen::VectorXd shape = tet_shape(static_cast<int>(n), place);
      const double jacobian = (tet_shape_derivative(static_cast<int>(n), place) * x.transpose()).determinant();
      sum += weight * jacobian * (d * shape - exact(x * shape)).squaredNorm();
    }
  }
  return std::sqrt(sum);
}

double solve(int order, int cells) {
  const TetMesh mesh = make_box_mesh({1.0, 1.0, 1.0}, cells, cells, cells, order);
  ElasticBody body(mesh, ElasticBody::Law::linear, kLame, 1.0, boundary_dofs(mesh));
  body.set_load(body.mass() * nodal(mesh, body_force));
  const Eigen::VectorXd boundary = nodal(mesh, exact);
  return l2_error(mesh, equilibrium(body, boundary, Eigen::VectorXd::Zero(boundary.size()), 1));
}

TEST(Convergence, FourNodeTetrahedraAreOfSecondOrder) {
  const double coarse = solve(1, 6), fine = solve(1, 12), order = std::log2(coarse / fine);
  std::printf("order in space, 4 nodes: %.2f (L2 error %.1e to %.1e)\n", order, coarse, fine);
  EXPECT_NEAR(order, 2.0, 0.15);
}

TEST(Convergence, TenNodeTetrahedraAreOfThirdOrder) {
  const double coarse = solve(2, 3), fine = solve(2, 6), order = std::log2(coarse / fine);
  std::printf("order in space, 10 nodes: %.2f (L2 error %.1e to %.1e)\n", order, coarse, fine);
  EXPECT_NEAR(order, 3.0, 0.15);
}

}  // namespace
}  // namespace tissue_stiffness
