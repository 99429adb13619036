#include "fem/discretisation.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

Eigen::Vector4d barycentric(const Eigen::Vector3d& rst) {
  return {1.0 - rst.sum(), rst.x(), rst.y(), rst.z()};
}

}  // namespace

Eigen::VectorXd tet_shape(int nodes, const Eigen::Vector3d& rst) {
  const Eigen::Vector4d l = barycentric(rst);
  if (nodes == 4) return l;
  Eigen::VectorXd n(10);
  for (int i = 0; i < 4; ++i) n[i] = l[i] * (2.0 * l[i] - 1.0);
  for (int k = 0; k < 6; ++k) {
    const auto& edge = kEdges[static_cast<std::size_t>(k)];
    n[4 + k] = 4.0 * l[edge[0]] * l[edge[1]];
  }
  return n;
}

Eigen::MatrixXd tet_shape_derivative(int nodes, const Eigen::Vector3d& rst) {
  Eigen::Matrix<double, 3, 4> dl;
  dl.col(0).setConstant(-1.0);
  dl.rightCols<3>().setIdentity();
  if (nodes == 4) return dl;
  const Eigen::Vector4d l = barycentric(rst);
  Eigen::MatrixXd d(3, 10);
  for (int i = 0; i < 4; ++i) d.col(i) = (4.0 * l[i] - 1.0) * dl.col(i);
  for (int k = 0; k < 6; ++k) {
    const auto& edge = kEdges[static_cast<std::size_t>(k)];
    d.col(4 + k) = 4.0 * (l[edge[0]] * dl.col(edge[1]) + l[edge[1]] * dl.col(edge[0]));
  }
  return d;
}

}  // namespace tissue_stiffness
