#include "tissue_stiffness/fem/nodal_rotation.hpp"

#include <Eigen/LU>

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 20;
constexpr double kPrecision = 1e-6;
constexpr double kFlat = 0.05;  // determinant below which a rotation says nothing

// Newton's iteration for the polar decomposition (Higham 1986).
Eigen::Matrix3d rotation(const Eigen::Matrix3d& f) {
  if (!(f.determinant() > kFlat)) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d r = f;
  for (int k = 0; k < kMostIterations; ++k) {
    const Eigen::Matrix3d next = 0.5 * (r + r.inverse().transpose());
    const bool settled = (next - r).cwiseAbs().maxCoeff() < kPrecision;
    r = next;
    if (settled) break;
  }
  return r;
}

}  // namespace

Eigen::Matrix3Xd nodal_rotations(const Discretisation& fem, const Eigen::VectorXd& u) {
  const int n = fem.nodes_per_element();
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, fem.dof_count());
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(fem.node_count());
  for (int e = 0; e < fem.element_count(); ++e) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    double weight = 0.0;
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const auto g = fem.gradient(e, q);
      for (int a = 0; a < n; ++a) {
        gradient += fem.weight(e, q) * u.segment<3>(3 * fem.elements()(a, e)) * g.col(a).transpose();
      }
      weight += fem.weight(e, q);
    }
    for (int a = 0; a < n; ++a) {
      const int node = fem.elements()(a, e);
      sum.middleCols<3>(3 * node) += gradient;
      volume[node] += weight;
    }
  }
  for (int node = 0; node < fem.node_count(); ++node) {
    auto f = sum.middleCols<3>(3 * node);
    if (volume[node] > 0.0) f /= volume[node];
    f = rotation(Eigen::Matrix3d(f + Eigen::Matrix3d::Identity()));
  }
  return sum;
}

}  // namespace tissue_stiffness
