#include "fem/point_assembly.hpp"

#include <Eigen/LU>
#include <numeric>
#include <string>

#include "fem/element_forces.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

template <int N>
Eigen::Matrix3d deformation_gradient(const Nodal<N>& u, const Eigen::Map<const Nodal<N>>& g, int e) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f.noalias() += u * g.transpose();
  if (!(f.determinant() > 0.0)) throw NumericalError("tetrahedron " + std::to_string(e) + " turned inside out");
  return f;
}

// Calls act(e, q, gradients of the shapes, F) at every point.
template <int N, typename Act>
void at_points(const Discretisation& fem, int e, const Eigen::VectorXd& u, const Act& act) {
  const Nodal<N> local = gather<N>(fem.elements(), e, u);
  for (int q = 0; q < fem.points_per_element(); ++q) {
    const Eigen::Map<const Nodal<N>> g(fem.gradient(e, q).data());
    act(q, g, deformation_gradient<N>(local, g, e));
  }
}

template <int N>
void subtract_forces(const Discretisation& fem, const std::vector<int>& elements, const NodeCorners& corners,
                     VectorPool& scratch, const PointStress& stress, const Eigen::VectorXd& u, Eigen::VectorXd& force) {
  const auto internal = [&](int e) {
    Nodal<N> out = Nodal<N>::Zero();
    at_points<N>(fem, e, u, [&](int q, const Eigen::Map<const Nodal<N>>& g, const Eigen::Matrix3d& f) {
      Eigen::Matrix3d p = Eigen::Matrix3d::Zero();
      stress(e, q, f, p);
      out.noalias() += (fem.weight(e, q) * p) * g;
    });
    return out;
  };
  subtract_element_forces<N>(elements, corners, fem.node_count(), scratch, internal, force);
}

// Adds w g^T A g of one point. Column k + 3 L of A belongs to dF_kL, whose gradient along node b is g_L of that node.
template <int N>
void add_point(double weight, const StressTangent& a, const Eigen::Map<const Nodal<N>>& g,
               Eigen::Matrix<double, 3 * N, 3 * N>& block) {
  for (int b = 0; b < N; ++b) {
    Eigen::Matrix<double, 9, 3> column = (weight * g(0, b)) * a.leftCols<3>();
    column.noalias() += (weight * g(1, b)) * a.middleCols<3>(3);
    column.noalias() += (weight * g(2, b)) * a.rightCols<3>();
    for (int c = 0; c < N; ++c) {
      auto part = block.template block<3, 3>(3 * c, 3 * b);
      for (int j = 0; j < 3; ++j) part.noalias() += g(j, c) * column.middleRows<3>(3 * j);
    }
  }
}

template <int N>
void add_tangents(const Discretisation& fem, const PointTangent& tangent, const Eigen::VectorXd& u, SparseMatrix& k) {
  for (int e = 0; e < fem.element_count(); ++e) {
    Eigen::Matrix<double, 3 * N, 3 * N> block = Eigen::Matrix<double, 3 * N, 3 * N>::Zero();
    at_points<N>(fem, e, u, [&](int q, const Eigen::Map<const Nodal<N>>& g, const Eigen::Matrix3d& f) {
      StressTangent a = StressTangent::Zero();
      tangent(e, q, f, a);
      if (!a.isZero(0.0)) add_point<N>(fem.weight(e, q), a, g, block);
    });
    for (int b = 0; b < N; ++b) {
      for (int c = 0; c < N; ++c) fem.add_block(k, e, c, b, block.template block<3, 3>(3 * c, 3 * b));
    }
  }
}

template <int N>
double sum_energy(const Discretisation& fem, const PointEnergy& density, const Eigen::VectorXd& u) {
  double sum = 0.0;
  for (int e = 0; e < fem.element_count(); ++e) {
    at_points<N>(fem, e, u, [&](int q, const Eigen::Map<const Nodal<N>>&, const Eigen::Matrix3d& f) {
      sum += fem.weight(e, q) * density(e, q, f);
    });
  }
  return sum;
}

std::vector<int> all_elements(const Discretisation& fem) {
  std::vector<int> all(static_cast<std::size_t>(fem.element_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

struct PointAssembly::Sums {
  explicit Sums(const Discretisation& fem)
      : elements(all_elements(fem)), corners(fem.elements(), elements, fem.node_count()) {}

  std::vector<int> elements;
  NodeCorners corners;  ///< of each node, for its parts of the elements' forces
  VectorPool scratch;   ///< buffers for these parts, one for each concurrent sum
};

PointAssembly::PointAssembly(const Discretisation& fem) : fem_(fem) {}
PointAssembly::~PointAssembly() = default;

PointAssembly::Sums& PointAssembly::sums() const {
  std::call_once(made_, [this] { sums_ = std::make_unique<Sums>(fem_); });
  return *sums_;
}

void PointAssembly::add_force(const PointStress& stress, const Eigen::VectorXd& u, Eigen::VectorXd& force) const {
  Sums& s = sums();
  fem_.nodes_per_element() == 10 ? subtract_forces<10>(fem_, s.elements, s.corners, s.scratch, stress, u, force)
                                 : subtract_forces<4>(fem_, s.elements, s.corners, s.scratch, stress, u, force);
}

void PointAssembly::add_stiffness(const PointTangent& tangent, const Eigen::VectorXd& u, SparseMatrix& stiffness) const {
  fem_.nodes_per_element() == 10 ? add_tangents<10>(fem_, tangent, u, stiffness)
                                 : add_tangents<4>(fem_, tangent, u, stiffness);
}

double PointAssembly::energy(const PointEnergy& density, const Eigen::VectorXd& u) const {
  return fem_.nodes_per_element() == 10 ? sum_energy<10>(fem_, density, u) : sum_energy<4>(fem_, density, u);
}

}  // namespace tissue_stiffness
