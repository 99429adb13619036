#include "fem/facet_quadrature.hpp"

#include <Eigen/Geometry>

namespace tissue_stiffness {
namespace {

Eigen::VectorXd triangle_shape(int nodes, double r, double s) {
  const double t = 1.0 - r - s;
  if (nodes == 3) return Eigen::Vector3d(t, r, s);
  Eigen::VectorXd n(6);
  n << t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t;
  return n;
}

Eigen::MatrixX2d triangle_derivative(int nodes, double r, double s) {
  const double t = 1.0 - r - s;
  Eigen::MatrixX2d d(nodes, 2);
  if (nodes == 3) {
    d << -1, -1, 1, 0, 0, 1;
  } else {
    d << 1 - 4 * t, 1 - 4 * t, 4 * r - 1, 0, 0, 4 * s - 1, 4 * (t - r), -4 * r, 4 * s, 4 * r, -4 * s, 4 * (t - s);
  }
  return d;
}

// Returns the points in each part of a divided triangle: n (n + 1) / 2 upright parts and n (n - 1) / 2 reversed ones.
Eigen::Matrix2Xd divided(const Eigen::Matrix2Xd& points, int n) {
  Eigen::Matrix2Xd out(2, points.cols() * n * n);
  Eigen::Index next = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      const Eigen::Vector2d corner(i, j), opposite(i + 1, j + 1);
      out.middleCols(next, points.cols()) = (points.colwise() + corner) / n;
      next += points.cols();
      if (i + j + 2 > n) continue;
      out.middleCols(next, points.cols()) = (-points).colwise() + opposite;
      out.middleCols(next, points.cols()) /= n;
      next += points.cols();
    }
  }
  return out;
}

}  // namespace

FacetQuadrature::FacetQuadrature(int nodes, int divisions) {
  Eigen::Matrix2Xd points;
  if (nodes == 3) {
    points.resize(2, 3);
    weights_ = Eigen::VectorXd::Constant(3, 1.0 / 6.0);
    points << 1.0 / 6, 2.0 / 3, 1.0 / 6, 1.0 / 6, 1.0 / 6, 2.0 / 3;
  } else {
    const double a = 0.445948490915965, b = 0.091576213509771, wa = 0.111690794839005, wb = 0.054975871827661;
    points.resize(2, 6);
    points << a, 1 - 2 * a, a, b, 1 - 2 * b, b, a, a, 1 - 2 * a, b, b, 1 - 2 * b;
    weights_.resize(6);
    weights_ << wa, wa, wa, wb, wb, wb;
    weights_ *= 0.5 / weights_.sum();
  }
  points = divided(points, divisions);
  weights_ = (weights_ / (divisions * divisions)).replicate(divisions * divisions, 1).eval();
  shape_.resize(nodes, points.cols());
  for (Eigen::Index q = 0; q < points.cols(); ++q) {
    shape_.col(q) = triangle_shape(nodes, points(0, q), points(1, q));
    derivatives_.push_back(triangle_derivative(nodes, points(0, q), points(1, q)));
  }
}

Eigen::Vector3d FacetQuadrature::normal(const FacetNodes& x, int q) const {
  const Eigen::Matrix<double, 3, 2> tangents = x * derivative(q);
  return tangents.col(0).cross(tangents.col(1));
}

FacetNodes facet_nodes(const TetMesh& mesh, int facet, const Eigen::VectorXd* displacement) {
  FacetNodes x(3, mesh.facets.rows());
  for (Eigen::Index a = 0; a < x.cols(); ++a) {
    const int node = mesh.facets(a, facet);
    x.col(a) = mesh.nodes.col(node);
    if (displacement != nullptr) x.col(a) += displacement->segment<3>(3 * node);
  }
  return x;
}

SparseMatrix facet_mass(const TetMesh& mesh, const std::vector<int>& facets) {
  const FacetQuadrature rule(static_cast<int>(mesh.facets.rows()));
  std::vector<Eigen::Triplet<double>> entries;
  for (const int f : facets) {
    const FacetNodes x = facet_nodes(mesh, f);
    Eigen::MatrixXd local = Eigen::MatrixXd::Zero(x.cols(), x.cols());
    for (int q = 0; q < rule.points(); ++q) {
      local += rule.weight(q) * rule.normal(x, q).norm() * rule.shape(q) * rule.shape(q).transpose();
    }
    for (Eigen::Index b = 0; b < x.cols(); ++b) {
      for (Eigen::Index a = 0; a < x.cols(); ++a) {
        for (int i = 0; i < 3; ++i) {
          entries.emplace_back(3 * mesh.facets(a, f) + i, 3 * mesh.facets(b, f) + i, local(a, b));
        }
      }
    }
  }
  SparseMatrix result(3 * mesh.node_count(), 3 * mesh.node_count());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

std::vector<int> facet_local_nodes(const TetMesh& mesh, int facet) {
  std::vector<int> local;
  const auto tet = mesh.tets.col(mesh.facet_tet[facet]);
  for (Eigen::Index a = 0; a < mesh.facets.rows(); ++a) {
    int k = 0;
    while (tet[k] != mesh.facets(a, facet)) ++k;
    local.push_back(k);
  }
  return local;
}

Eigen::VectorXd facet_mean(const TetMesh& mesh, const std::vector<int>& facets) {
  const FacetQuadrature rule(static_cast<int>(mesh.facets.rows()));
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(mesh.node_count());
  for (const int f : facets) {
    const FacetNodes x = facet_nodes(mesh, f);
    for (int q = 0; q < rule.points(); ++q) {
      const double area = rule.weight(q) * rule.normal(x, q).norm();
      for (Eigen::Index a = 0; a < x.cols(); ++a) weights[mesh.facets(a, f)] += area * rule.shape(q)[a];
    }
  }
  return weights / weights.sum();
}

Eigen::VectorXd along_axis(const Eigen::VectorXd& weights, int axis) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(3 * weights.size());
  for (Eigen::Index a = 0; a < weights.size(); ++a) out[3 * a + axis] = weights[a];
  return out;
}

Eigen::Vector3d resultant(const Eigen::VectorXd& forces) {
  return Eigen::Map<const Eigen::Matrix3Xd>(forces.data(), 3, forces.size() / 3).rowwise().sum();
}

}  // namespace tissue_stiffness
