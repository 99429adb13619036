#include "observation/surface_anchor.hpp"

#include <Eigen/LU>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

Eigen::Vector3d SurfaceAnchor::displacement(const TetMesh& mesh, const Eigen::Ref<const Eigen::VectorXd>& u) const {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < shape.size(); ++k) out += shape[k] * u.segment<3>(3 * mesh.tets(k, tet));
  return out;
}

SurfaceAnchor anchor_on(const TetMesh& mesh, int facet, const Eigen::Vector3d& point) {
  SurfaceAnchor out;
  out.tet = mesh.facet_tet[facet];
  Eigen::Matrix3d edges;
  const Eigen::Vector3d origin = mesh.nodes.col(mesh.tets(0, out.tet));
  for (int i = 0; i < 3; ++i) edges.col(i) = mesh.nodes.col(mesh.tets(i + 1, out.tet)) - origin;
  const Eigen::Vector3d rst = edges.inverse() * (point - origin);
  const int n = static_cast<int>(mesh.tets.rows());
  out.shape = tet_shape(n, rst);
  const Eigen::MatrixXd derivative = tet_shape_derivative(n, rst);
  Eigen::Matrix3Xd x(3, n);
  for (int k = 0; k < n; ++k) x.col(k) = mesh.nodes.col(mesh.tets(k, out.tet));
  out.gradient = (derivative * x.transpose()).inverse() * derivative;
  Eigen::Index nearest = 0;
  (x.colwise() - point).colwise().squaredNorm().minCoeff(&nearest);
  out.node = mesh.tets(nearest, out.tet);
  return out;
}

}  // namespace tissue_stiffness
