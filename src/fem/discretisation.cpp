#include "fem/discretisation.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
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

// This is the rule of Walkington (2000) with 14 points of degree 5.
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

// Shape functions at the points of a rule, computed once for all elements.
struct ShapeTable {
  ShapeTable(int nodes, const std::vector<QuadraturePoint>& rule) {
    for (const QuadraturePoint& point : rule) {
      weights.push_back(point.weight);
      shapes.push_back(tet_shape(nodes, point.rst));
      derivatives.emplace_back(tet_shape_derivative(nodes, point.rst));
    }
  }
  std::vector<double> weights;
  std::vector<Eigen::VectorXd> shapes;
  std::vector<Eigen::Matrix3Xd> derivatives;
};

// The rows are d/dr, d/ds, d/dt.
Eigen::Matrix3d jacobian(const Eigen::Matrix3Xd& derivative, const Eigen::Matrix3Xd& nodes, const Eigen::MatrixXi& elements,
                         int e) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (Eigen::Index a = 0; a < elements.rows(); ++a) {
    sum.noalias() += derivative.col(a) * nodes.col(elements(a, e)).transpose();
  }
  return sum;
}

}  // namespace

Discretisation::Discretisation(const TetMesh& mesh)
    : node_count_(mesh.node_count()), elements_(mesh.tets), nodes_(mesh.nodes) {
  compute_gradients();
  std::vector<int> all(static_cast<std::size_t>(element_count()));
  std::iota(all.begin(), all.end(), 0);
  corners_ = NodeCorners(elements_, all, node_count_);
  compute_pattern();
}

void Discretisation::compute_gradients() {
  const int n = nodes_per_element();
  const ShapeTable table(n, stiffness_rule(n));
  points_ = static_cast<int>(table.weights.size());
  weights_.resize(points_, element_count());
  positions_.resize(3, static_cast<Eigen::Index>(points_) * element_count());
  gradients_.resize(static_cast<std::size_t>(3 * n * points_) * static_cast<std::size_t>(element_count()));
  for (int e = 0; e < element_count(); ++e) {
    for (int q = 0; q < points_; ++q) {
      const auto point = static_cast<std::size_t>(q);
      const Eigen::Matrix3d j = jacobian(table.derivatives[point], nodes_, elements_, e);
      const double determinant = j.determinant();
      if (!(determinant > 0.0)) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (int a = 0; a < 4; ++a) middle += nodes_.col(elements_(a, e)) / 4.0;
        std::ostringstream where;
        where << "mesh: tetrahedron " << e << " at (" << middle.transpose() << ") m";
        throw InputError(where.str(), "a Jacobian of " + std::to_string(determinant), "positive");
      }
      weights_(q, e) = table.weights[point] * determinant;
      auto position = positions_.col(static_cast<Eigen::Index>(e) * points_ + q);
      position.setZero();
      for (int a = 0; a < n; ++a) position += table.shapes[point][a] * nodes_.col(elements_(a, e));
      const Eigen::Index at = 3 * n * (static_cast<Eigen::Index>(e) * points_ + q);
      Eigen::Map<Eigen::Matrix3Xd>(gradients_.data() + at, 3, n).noalias() = j.inverse() * table.derivatives[point];
    }
  }
}

void Discretisation::compute_pattern() {
  const int n = nodes_per_element();
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(node_count_));
  tbb::parallel_for(0, node_count_, [&](int node) {
    auto& list = neighbours[static_cast<std::size_t>(node)];
    for_each_corner(node, [&](int e, int) {
      for (int a = 0; a < n; ++a) list.push_back(elements_(a, e));
    });
    if (list.empty()) list.push_back(node);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  });
  pattern_.resize(3 * node_count_, 3 * node_count_);
  int* outer = pattern_.outerIndexPtr();
  outer[0] = 0;
  for (int column = 0; column < 3 * node_count_; ++column) {
    outer[column + 1] = outer[column] + static_cast<int>(3 * neighbours[static_cast<std::size_t>(column / 3)].size());
  }
  pattern_.resizeNonZeros(outer[3 * node_count_]);
  pattern_.coeffs().setZero();
  slots_.resize(slot(element_count(), 0, 0));
  tbb::parallel_for(0, node_count_, [&](int node) {
    const auto& list = neighbours[static_cast<std::size_t>(node)];
    for (int j = 0; j < 3; ++j) {
      int* to = pattern_.innerIndexPtr() + outer[3 * node + j];
      for (const int other : list) {
        for (int i = 0; i < 3; ++i) *to++ = 3 * other + i;
      }
    }
    for_each_corner(node, [&](int e, int b) {
      for (int a = 0; a < n; ++a) {
        const auto at = std::lower_bound(list.begin(), list.end(), elements_(a, e));
        slots_[slot(e, a, b)] = static_cast<int>(at - list.begin());
      }
    });
  });
}

// Every node sums its own columns. So threads share no data, and the order of a sum does not depend on them.
template <typename Block>
SparseMatrix Discretisation::assemble(const Eigen::VectorXd& element_weight, const Block& block) const {
  SparseMatrix result = pattern_;
  tbb::parallel_for(0, node_count_, [&](int node) {
    for_each_corner(node, [&](int e, int b) {
      if (element_weight[e] == 0.0) return;
      for (int a = 0; a < nodes_per_element(); ++a) add_block(result, e, a, b, element_weight[e] * block(e, a, b));
    });
  });
  return result;
}

double Discretisation::volume() const {
  return weights_.sum();
}

SparseMatrix Discretisation::mass(const Eigen::VectorXd& element_weight) const {
  const int n = nodes_per_element();
  const ShapeTable table(n, mass_rule());
  const auto points = static_cast<Eigen::Index>(table.weights.size());
  Eigen::MatrixXd products(n * n, points), determinants(points, element_count());
  for (Eigen::Index q = 0; q < points; ++q) {
    const auto at = static_cast<std::size_t>(q);
    const Eigen::MatrixXd product = table.weights[at] * table.shapes[at] * table.shapes[at].transpose();
    products.col(q) = Eigen::Map<const Eigen::VectorXd>(product.data(), product.size());
    for (int e = 0; e < element_count(); ++e) {
      determinants(q, e) = jacobian(table.derivatives[at], nodes_, elements_, e).determinant();
    }
  }
  const Eigen::MatrixXd local = products * determinants;
  return assemble(element_weight, [&](int e, int a, int b) -> Eigen::Matrix3d {
    return local(n * b + a, e) * Eigen::Matrix3d::Identity();
  });
}

SparseMatrix Discretisation::volumetric_stiffness(const Eigen::VectorXd& element_weight) const {
  return assemble(element_weight, [this](int e, int a, int b) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int q = 0; q < points_; ++q) {
      const auto g = gradient(e, q);
      sum.noalias() += (weight(e, q) * g.col(a)) * g.col(b).transpose();
    }
    return sum;
  });
}

// For nodes a and b with shape gradients g, the shear modulus' part is w g_b g_a^T + w (g_a . g_b) I, and this matrix has w
// g_a g_b^T.
void Discretisation::make_elastic(double lambda, double mu, SparseMatrix& volumetric) const {
  const int* outer = pattern_.outerIndexPtr();
  tbb::parallel_for(0, node_count_, [&](int node) {
    const int* starts = outer + 3 * node;
    for (int k = 0; k < (starts[1] - starts[0]) / 3; ++k) {
      const auto column = [&](int j) { return Eigen::Map<Eigen::Vector3d>(volumetric.valuePtr() + starts[j] + 3 * k); };
      Eigen::Matrix3d block;
      for (int j = 0; j < 3; ++j) block.col(j) = column(j);
      Eigen::Matrix3d shear = block.transpose();
      shear.diagonal().array() += block.trace();
      for (int j = 0; j < 3; ++j) column(j) = lambda * block.col(j) + mu * shear.col(j);
    }
  });
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

bool same_matrix(const SparseMatrix& a, const SparseMatrix& b) {
  if (&a == &b) return true;
  const auto count = static_cast<std::size_t>(a.nonZeros());
  return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + count, b.innerIndexPtr()) &&
         std::equal(a.valuePtr(), a.valuePtr() + count, b.valuePtr());
}

}  // namespace tissue_stiffness
