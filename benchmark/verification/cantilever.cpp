// A slender square cantilever without Poisson effect against Timoshenko's beam theory.
#include <Eigen/LU>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "elastic_body.hpp"
#include "fem/facet_quadrature.hpp"
#include "figures.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLength = 0.10, kSide = 0.01, kModulus = 100e3, kDensity = 1000.0;
constexpr double kArea = kSide * kSide, kInertia = kArea * kSide * kSide / 12.0;
constexpr double kShearStiffness = 5.0 / 6.0 * (0.5 * kModulus) * kArea;  // k G A; Cowper (1966): k = 5/6 at nu = 0
constexpr double kBending = kModulus * kInertia;

TetMesh bar() {
  return make_box_mesh({kLength, kSide, kSide}, 16, 2, 2, 2);
}

// Shape functions' mean over the free end: a unit load spread evenly, and the mean deflection that it does work on.
Eigen::VectorXd end_weights(const TetMesh& mesh) {
  const FacetQuadrature rule(6);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(3 * mesh.node_count());
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const FacetNodes x = facet_nodes(mesh, f);
    if (x.row(0).minCoeff() < kLength - 1e-9) continue;
    for (int q = 0; q < rule.points(); ++q) {
      const double area = rule.weight(q) * rule.normal(x, q).norm();
      for (Eigen::Index a = 0; a < 6; ++a) w[3 * mesh.facets(a, f) + 2] += area / kArea * rule.shape(q)[a];
    }
  }
  return w;
}

// Over Timoshenko's.
double static_deflection() {
  const TetMesh mesh = bar();
  ElasticBody body(mesh, ElasticBody::Law::linear, lame(kModulus, 0.0), kDensity, clamped_dofs(mesh));
  const Eigen::VectorXd w = end_weights(mesh), zero = Eigen::VectorXd::Zero(w.size());
  const double load = 1e-4;
  body.set_load(load * w);
  const double deflection = w.dot(equilibrium(body, zero, zero, 1));
  return deflection / (load * (std::pow(kLength, 3) / (3.0 * kBending) + kLength / kShearStiffness));
}

// Determinant that vanishes at a natural frequency: (w, psi, M, V) carried from the clamp to the free end.
double frequency_determinant(double omega) {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 1) = 1.0;  // w' = psi + V / kGA
  a(0, 3) = 1.0 / kShearStiffness;
  a(1, 2) = 1.0 / kBending;                        // psi' = M / EI
  a(2, 1) = -kDensity * kInertia * omega * omega;  // M' = -V - rho I omega^2 psi
  a(2, 3) = -1.0;
  a(3, 0) = -kDensity * kArea * omega * omega;  // V' = -rho A omega^2 w
  const Eigen::Matrix4d carried = (a * kLength).exp();
  return carried.bottomRightCorner<2, 2>().determinant();
}

double timoshenko_frequency() {
  const double bernoulli = 1.8751 * 1.8751 * std::sqrt(kBending / (kDensity * kArea)) / (kLength * kLength);
  double low = 0.5 * bernoulli, high = 1.2 * bernoulli;
  if (frequency_determinant(low) * frequency_determinant(high) > 0.0) throw NumericalError("no frequency in the bracket");
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (frequency_determinant(middle) * frequency_determinant(low) > 0.0 ? low : high) = middle;
  }
  return low;
}

// Over Timoshenko's.
double first_frequency() {
  const TetMesh mesh = bar();
  const ElasticBody body(mesh, ElasticBody::Law::linear, lame(kModulus, 0.0), kDensity, clamped_dofs(mesh));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(body.fem().dof_count());
  SparseMatrix k = body.stiffness(0.0, zero, zero);
  fix_dofs(k, body.fixed(), k.diagonal().mean());
  SparseSolver solver;
  solver.factorize(k);
  Eigen::VectorXd x = end_weights(mesh);
  double square = 0.0;
  for (int i = 0; i < 20; ++i) {  // inverse iteration
    Eigen::VectorXd load = body.mass() * x;
    for (Eigen::Index d = 0; d < load.size(); ++d) {
      if (body.fixed()[static_cast<std::size_t>(d)] != 0) load[d] = 0.0;
    }
    x = solver.solve(load);
    x /= x.norm();
    square = x.dot(k * x) / x.dot(body.mass() * x);
  }
  return std::sqrt(square) / timoshenko_frequency();
}

}  // namespace

std::vector<Figure> cantilever_figures() {
  return {{"cantilever, static deflection over Timoshenko's", static_deflection(), 0.995, 1.005},
          {"cantilever, first frequency over Timoshenko's", first_frequency(), 0.995, 1.005}};
}

}  // namespace tissue_stiffness
