#include "fem/principal_stretches.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "fem/invariants.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kEqual = 1e-6;  // stretches closer than this share one limit

// Returns (g_a - g_b) / (lambda_a - lambda_b).
double divided_difference(const PrincipalStretches& at, const Eigen::Vector3d& g, const Eigen::Matrix3d& slopes, int a,
                          int b) {
  const double apart = at.stretches[a] - at.stretches[b];
  if (std::abs(apart) > kEqual) return (g[a] - g[b]) / apart;
  return 0.5 * (slopes(a, a) + slopes(b, b)) - slopes(a, b);
}

}  // namespace

PrincipalStretches principal_stretches(const Eigen::Matrix3d& f) {
  if (!(f.determinant() > 0.0)) throw NumericalError("a sampled point turned inside out");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(f.transpose() * f);
  PrincipalStretches out;
  out.stretches = eigen.eigenvalues().cwiseSqrt();
  out.material = eigen.eigenvectors();
  out.spatial = f * out.material * out.stretches.cwiseInverse().asDiagonal();
  return out;
}

Eigen::Matrix3d principal_stress(const PrincipalStretches& at, const Eigen::Vector3d& g) {
  return at.spatial * g.asDiagonal() * at.material.transpose();
}

StressTangent principal_tangent(const PrincipalStretches& at, const Eigen::Vector3d& g, const Eigen::Matrix3d& slopes) {
  const auto dyad = [&](int a, int b) -> Eigen::Matrix3d { return at.spatial.col(a) * at.material.col(b).transpose(); };
  StressTangent out = StressTangent::Zero();
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      out += slopes(a, b) * outer(dyad(a, a), dyad(b, b));
      if (a == b) continue;
      const double sum = divided_difference(at, g, slopes, a, b),
                   difference = (g[a] + g[b]) / (at.stretches[a] + at.stretches[b]);
      out += 0.5 * (sum + difference) * outer(dyad(a, b), dyad(a, b)) +
             0.5 * (sum - difference) * outer(dyad(a, b), dyad(b, a));
    }
  }
  return out;
}

}  // namespace tissue_stiffness
