#include "meshing/quality.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

Eigen::Matrix<double, 3, 4> corners(const TetMesh& mesh, int tet) {
  Eigen::Matrix<double, 3, 4> x;
  for (int i = 0; i < 4; ++i) x.col(i) = mesh.nodes.col(mesh.tets(i, tet));
  return x;
}

// Returns the outward area vectors of the faces.
Eigen::Matrix<double, 3, 4> face_areas(const Eigen::Matrix<double, 3, 4>& x) {
  Eigen::Matrix<double, 3, 4> areas;
  for (int face = 0; face < 4; ++face) {
    const auto& f = kTetFaces[static_cast<std::size_t>(face)];
    const Eigen::Vector3d a = x.col(f[1]) - x.col(f[0]), b = x.col(f[2]) - x.col(f[0]);
    areas.col(face) = 0.5 * a.cross(b);
  }
  return areas;
}

double radius_ratio(const Eigen::Matrix<double, 3, 4>& x, double volume) {
  const double inscribed = 3.0 * volume / face_areas(x).colwise().norm().sum();
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i) edges.row(i) = (x.col(i + 1) - x.col(0)).transpose();
  const Eigen::Vector3d centre = edges.fullPivLu().solve(Eigen::Vector3d(0.5 * edges.rowwise().squaredNorm()));
  return 3.0 * inscribed / centre.norm();
}

double least_dihedral(const Eigen::Matrix<double, 3, 4>& x) {
  const Eigen::Matrix<double, 3, 4> normals = face_areas(x).colwise().normalized();
  double least = M_PI;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      least = std::min(least, M_PI - std::acos(std::clamp(normals.col(a).dot(normals.col(b)), -1.0, 1.0)));
    }
  }
  return least;
}

// Returns dN/d(r, s, t) of the 10-node tetrahedron at barycentric coordinates l.
Eigen::Matrix<double, 10, 3> shape_derivatives(const Eigen::Vector4d& l) {
  Eigen::Matrix<double, 4, 3> dl;
  dl << -1.0, -1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0;
  Eigen::Matrix<double, 10, 3> dn;
  for (int i = 0; i < 4; ++i) dn.row(i) = (4.0 * l[i] - 1.0) * dl.row(i);
  for (int e = 0; e < 6; ++e) {
    const auto& edge = kTetEdges[static_cast<std::size_t>(e)];
    dn.row(4 + e) = 4.0 * (l[edge[0]] * dl.row(edge[1]) + l[edge[1]] * dl.row(edge[0]));
  }
  return dn;
}

Eigen::Vector4d node_place(int node) {
  Eigen::Vector4d l = Eigen::Vector4d::Zero();
  if (node < 4) {
    l[node] = 1.0;
  } else {
    for (const int end : kTetEdges[static_cast<std::size_t>(node - 4)]) l[end] = 0.5;
  }
  return l;
}

}  // namespace

Eigen::VectorXd node_jacobians(const TetMesh& mesh, int tet) {
  if (!mesh.quadratic()) return Eigen::VectorXd::Constant(1, 6.0 * tet_volume(mesh, tet));
  Eigen::Matrix<double, 3, 10> x;
  for (int i = 0; i < 10; ++i) x.col(i) = mesh.nodes.col(mesh.tets(i, tet));
  Eigen::VectorXd jacobians(10);
  for (int i = 0; i < 10; ++i) jacobians[i] = (x * shape_derivatives(node_place(i))).determinant();
  return jacobians;
}

MeshQuality measure_quality(const TetMesh& mesh) {
  if (mesh.empty()) throw InputError("mesh", "no tetrahedra", "at least one");
  MeshQuality quality;
  quality.least_radius_ratio = quality.least_jacobian_ratio = std::numeric_limits<double>::infinity();
  quality.least_dihedral_angle = M_PI;
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    const Eigen::Matrix<double, 3, 4> x = corners(mesh, tet);
    const double volume = tet_volume(mesh, tet);
    const double ratio = radius_ratio(x, volume);
    if (ratio < quality.least_radius_ratio) quality.worst_tet = tet;
    quality.least_radius_ratio = std::min(quality.least_radius_ratio, ratio);
    quality.mean_radius_ratio += ratio / mesh.tet_count();
    quality.least_dihedral_angle = std::min(quality.least_dihedral_angle, least_dihedral(x));
    const Eigen::VectorXd jacobians = node_jacobians(mesh, tet);
    quality.least_jacobian_ratio = std::min(quality.least_jacobian_ratio, jacobians.minCoeff() / jacobians.maxCoeff());
    quality.mean_edge_length += edge_lengths(mesh, tet).mean() / mesh.tet_count();
    quality.volume += volume;
  }
  return quality;
}

Eigen::Array<double, 6, 1> edge_lengths(const TetMesh& mesh, int tet) {
  Eigen::Array<double, 6, 1> out;
  for (int e = 0; e < 6; ++e) {
    const auto [a, b] = kTetEdges[static_cast<std::size_t>(e)];
    out[e] = (mesh.nodes.col(mesh.tets(a, tet)) - mesh.nodes.col(mesh.tets(b, tet))).norm();
  }
  return out;
}

std::string describe_quality(const TetMesh& mesh, const MeshQuality& quality) {
  std::ostringstream out;
  out.precision(3);
  out << mesh.tet_count() << (mesh.quadratic() ? " 10-node" : " 4-node") << " tetrahedra, " << mesh.node_count()
      << " nodes, mean edge " << 1e3 * quality.mean_edge_length << " mm, volume " << 1e6 * quality.volume
      << " cm^3, radius ratio least " << quality.least_radius_ratio << " mean " << quality.mean_radius_ratio
      << ", least dihedral angle " << quality.least_dihedral_angle * 180.0 / M_PI << " deg";
  if (mesh.quadratic()) out << ", least Jacobian ratio " << quality.least_jacobian_ratio;
  return out.str();
}

}  // namespace tissue_stiffness
