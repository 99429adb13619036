#include "tissue_stiffness/fem/discretisation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

struct QuadraturePoint {
  Eigen::Vector3d rst;
  double weight;  // of the unit tetrahedron, sums to 1/6
};

std::vector<QuadraturePoint> stiffness_rule(int nodes) {
  if (nodes == 4) return {{Eigen::Vector3d::Constant(0.25), 1.0 / 6.0}};
  const double a = (5.0 - std::sqrt(5.0)) / 20.0, b = 1.0 - 3.0 * a, w = 1.0 / 24.0;
  return {{{a, a, a}, w}, {{b, a, a}, w}, {{a, b, a}, w}, {{a, a, b}, w}};
}

// Walkington (2000), 14 points, degree 5.
std::vector<QuadraturePoint> mass_rule() {
  std::vector<QuadraturePoint> rule;
  const auto vertex_orbit = [&rule](double a, double w) {
    const double b = 1.0 - 3.0 * a;
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(a, a, a), Eigen::Vector3d(b, a, a), Eigen::Vector3d(a, b, a), Eigen::Vector3d(a, a, b)}) {
      rule.push_back({p, w / 6.0});
    }
  };
  vertex_orbit(0.31088591926330060980, 0.11268792571801585080);
  vertex_orbit(0.092735250310891226402, 0.073493043116361949544);
  const double a = 0.045503704125649649492, b = 0.5 - a, w = 0.042546020777081466438 / 6.0;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(a, a, b), Eigen::Vector3d(a, b, a), Eigen::Vector3d(b, a, a),
                                   Eigen::Vector3d(b, b, a), Eigen::Vector3d(b, a, b), Eigen::Vector3d(a, b, b)}) {
    rule.push_back({p, w});
  }
  return rule;
}

Eigen::Matrix3Xd element_nodes(const Eigen::Matrix3Xd& nodes, const Eigen::MatrixXi& elements, int e) {
  Eigen::Matrix3Xd x(3, elements.rows());
  for (Eigen::Index a = 0; a < elements.rows(); ++a) x.col(a) = nodes.col(elements(a, e));
  return x;
}

}  // namespace

Discretisation::Discretisation(const TetMesh& mesh)
    : node_count_(mesh.node_count()), elements_(mesh.tets), nodes_(mesh.nodes) {
  compute_gradients(mesh);
  compute_pattern();
}

void Discretisation::compute_gradients(const TetMesh& mesh) {
  const int n = nodes_per_element();
  const std::vector<QuadraturePoint> rule = stiffness_rule(n);
  points_ = static_cast<int>(rule.size());
  weights_.resize(points_, element_count());
  positions_.resize(3, static_cast<Eigen::Index>(points_) * element_count());
  gradients_.resize(static_cast<std::size_t>(3 * n * points_) * static_cast<std::size_t>(element_count()));
  for (int e = 0; e < element_count(); ++e) {
    const Eigen::Matrix3Xd x = element_nodes(mesh.nodes, elements_, e);
    for (int q = 0; q < points_; ++q) {
      const auto& point = rule[static_cast<std::size_t>(q)];
      const Eigen::MatrixXd d = tet_shape_derivative(n, point.rst);
      const Eigen::Matrix3d jacobian = d * x.transpose();  // rows: d/dr, d/ds, d/dt
      const double determinant = jacobian.determinant();
      if (!(determinant > 0.0)) {
        std::ostringstream where;
        where << "mesh: tetrahedron " << e << " at (" << x.leftCols<4>().rowwise().mean().transpose() << ") m";
        throw InputError(where.str(), "a Jacobian of " + std::to_string(determinant), "positive");
      }
      weights_(q, e) = point.weight * determinant;
      positions_.col(static_cast<Eigen::Index>(e) * points_ + q) = x * tet_shape(n, point.rst);
      const Eigen::Index at = 3 * n * (static_cast<Eigen::Index>(e) * points_ + q);
      Eigen::Map<Eigen::Matrix3Xd>(gradients_.data() + at, 3, n) = jacobian.inverse() * d;
    }
  }
}

void Discretisation::compute_pattern() {
  const int n = nodes_per_element();
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(node_count_));
  for (int e = 0; e < element_count(); ++e) {
    for (int b = 0; b < n; ++b) {
      auto& list = neighbours[static_cast<std::size_t>(elements_(b, e))];
      for (int a = 0; a < n; ++a) list.push_back(elements_(a, e));
    }
  }
  Eigen::VectorXi sizes(3 * node_count_);
  for (int b = 0; b < node_count_; ++b) {
    auto& list = neighbours[static_cast<std::size_t>(b)];
    if (list.empty()) list.push_back(b);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    sizes.segment<3>(3 * b).setConstant(static_cast<int>(3 * list.size()));
  }
  pattern_.resize(3 * node_count_, 3 * node_count_);
  pattern_.reserve(sizes);
  for (int b = 0; b < node_count_; ++b) {
    for (int j = 0; j < 3; ++j) {
      for (const int a : neighbours[static_cast<std::size_t>(b)]) {
        for (int i = 0; i < 3; ++i) pattern_.insert(3 * a + i, 3 * b + j) = 0.0;
      }
    }
  }
  pattern_.makeCompressed();
  slots_.resize(static_cast<std::size_t>(element_count() * n * n));
  for (int e = 0; e < element_count(); ++e) {
    for (int b = 0; b < n; ++b) {
      const auto& list = neighbours[static_cast<std::size_t>(elements_(b, e))];
      for (int a = 0; a < n; ++a) {
        const auto at = std::lower_bound(list.begin(), list.end(), elements_(a, e));
        slots_[static_cast<std::size_t>((e * n + b) * n + a)] = static_cast<int>(at - list.begin());
      }
    }
  }
}

SparseMatrix Discretisation::mass(const Eigen::VectorXd& element_weight) const {
  const int n = nodes_per_element();
  SparseMatrix result = pattern_;
  const std::vector<QuadraturePoint> rule = mass_rule();
  for (int e = 0; e < element_count(); ++e) {
    if (element_weight[e] == 0.0) continue;
    const Eigen::Matrix3Xd x = element_nodes(nodes_, elements_, e);
    Eigen::MatrixXd local = Eigen::MatrixXd::Zero(n, n);
    for (const auto& point : rule) {
      const Eigen::VectorXd shape = tet_shape(n, point.rst);
      const double jacobian = (tet_shape_derivative(n, point.rst) * x.transpose()).determinant();
      local.noalias() += point.weight * jacobian * element_weight[e] * shape * shape.transpose();
    }
    for (int b = 0; b < n; ++b) {
      for (int a = 0; a < n; ++a) add_block(result, e, a, b, local(a, b) * Eigen::Matrix3d::Identity());
    }
  }
  return result;
}

SparseMatrix Discretisation::volumetric_stiffness(const Eigen::VectorXd& element_weight) const {
  const int n = nodes_per_element();
  SparseMatrix result = pattern_;
  for (int e = 0; e < element_count(); ++e) {
    if (element_weight[e] == 0.0) continue;
    for (int q = 0; q < points_; ++q) {
      const auto g = gradient(e, q);
      const double w = weight(e, q) * element_weight[e];
      for (int b = 0; b < n; ++b) {
        for (int a = 0; a < n; ++a) add_block(result, e, a, b, w * g.col(a) * g.col(b).transpose());
      }
    }
  }
  return result;
}

SparseMatrix Discretisation::shear_stiffness(const Eigen::VectorXd& element_weight) const {
  const int n = nodes_per_element();
  SparseMatrix result = pattern_;
  for (int e = 0; e < element_count(); ++e) {
    if (element_weight[e] == 0.0) continue;
    for (int q = 0; q < points_; ++q) {
      const auto g = gradient(e, q);
      const double w = weight(e, q) * element_weight[e];
      for (int b = 0; b < n; ++b) {
        for (int a = 0; a < n; ++a) {
          const Eigen::Matrix3d block =
              g.col(b) * g.col(a).transpose() + g.col(a).dot(g.col(b)) * Eigen::Matrix3d::Identity();
          add_block(result, e, a, b, w * block);
        }
      }
    }
  }
  return result;
}

void add_scaled(SparseMatrix& to, double scale, const SparseMatrix& part) {
  if (part.nonZeros() == to.nonZeros()) {  // all of its places
    to.coeffs() += scale * part.coeffs();
    return;
  }
  double* values = to.valuePtr();
  const int* rows = to.innerIndexPtr();
  for (Eigen::Index column = 0; column < part.outerSize(); ++column) {
    const int* at = rows + to.outerIndexPtr()[column];
    const int* end = rows + to.outerIndexPtr()[column + 1];
    for (SparseMatrix::InnerIterator entry(part, column); entry; ++entry) {
      at = std::lower_bound(at, end, static_cast<int>(entry.row()));
      values[at - rows] += scale * entry.value();
    }
  }
}

}  // namespace tissue_stiffness
