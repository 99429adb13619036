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

NodalRotations::NodalRotations(const Discretisation& fem) : fem_(fem), volume_(Eigen::VectorXd::Zero(fem.node_count())) {
  for (int e = 0; e < fem.element_count(); ++e) {
    double weight = 0.0;
    for (int q = 0; q < fem.points_per_element(); ++q) weight += fem.weight(e, q);
    for (int a = 0; a < fem.nodes_per_element(); ++a) volume_[fem.elements()(a, e)] += weight;
  }
}

void NodalRotations::find(const Eigen::VectorXd& u, Eigen::Matrix3Xd& rotations) const {
  rotations.setZero(3, fem_.dof_count());
  for (int e = 0; e < fem_.element_count(); ++e) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int q = 0; q < fem_.points_per_element(); ++q) {
      const auto g = fem_.gradient(e, q);
      for (int a = 0; a < fem_.nodes_per_element(); ++a) {
        gradient += fem_.weight(e, q) * u.segment<3>(3 * fem_.elements()(a, e)) * g.col(a).transpose();
      }
    }
    for (int a = 0; a < fem_.nodes_per_element(); ++a) rotations.middleCols<3>(3 * fem_.elements()(a, e)) += gradient;
  }
  for (int node = 0; node < fem_.node_count(); ++node) {
    auto f = rotations.middleCols<3>(3 * node);
    if (volume_[node] > 0.0) f /= volume_[node];
    f = rotation(Eigen::Matrix3d(f + Eigen::Matrix3d::Identity()));
  }
}

}  // namespace tissue_stiffness
