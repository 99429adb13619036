#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "fem/node_corners.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Isoparametric Lagrange tetrahedra (4 or 10 nodes) at rest. The class holds shape gradients and weights at the quadrature
/// points, and the sparsity pattern that every matrix of the model shares. Stiffness uses 1 (4 nodes) or 4 points (10
/// nodes, degree 2: exact for straight edges). Mass uses a 14-point rule of degree 5 (Walkington 2000).
class Discretisation {
 public:
  /// Computes gradients and pattern. Throws InputError naming an element whose Jacobian is not positive.
  explicit Discretisation(const TetMesh& mesh);

  int dof_count() const { return 3 * node_count_; }
  int node_count() const { return node_count_; }
  int element_count() const { return static_cast<int>(elements_.cols()); }
  int nodes_per_element() const { return static_cast<int>(elements_.rows()); }
  int points_per_element() const { return points_; }
  const Eigen::MatrixXi& elements() const { return elements_; }

  /// Returns dN/dX at quadrature point q of element e, 3 x nodes [1/m].
  Eigen::Map<const Eigen::Matrix3Xd> gradient(int e, int q) const {
    const Eigen::Index n = elements_.rows();
    return {gradients_.data() + 3 * n * (static_cast<Eigen::Index>(e) * points_ + q), 3, n};
  }
  /// Returns quadrature weight times Jacobian [m^3]. These products sum to the volume.
  double weight(int e, int q) const { return weights_(q, e); }
  double volume() const;
  /// Returns the position of quadrature point q of element e at rest [m].
  auto position(int e, int q) const { return positions_.col(static_cast<Eigen::Index>(e) * points_ + q); }

  /// Returns a zero matrix (dofs x dofs) with the pattern of the mesh: 3 x 3 blocks for nodes that share an element.
  const SparseMatrix& pattern() const { return pattern_; }

  /// Adds a 3 x 3 block at row node a and column node b of element e, in local numbers.
  void add_block(SparseMatrix& matrix, int e, int a, int b, const Eigen::Matrix3d& block) const {
    const int k = slots_[slot(e, a, b)];
    const int column = 3 * elements_(b, e);
    double* values = matrix.valuePtr();
    const int* outer = matrix.outerIndexPtr();
    for (int j = 0; j < 3; ++j) {
      double* to = values + outer[column + j] + 3 * k;
      for (int i = 0; i < 3; ++i) to[i] += block(i, j);
    }
  }

  /// Returns the consistent mass matrix of unit density, with a weight for each element (1 everywhere, or 1 inside a
  /// region) [m^3].
  SparseMatrix mass(const Eigen::VectorXd& element_weight) const;

  /// Returns the small-strain stiffness for Lame's first parameter = 1 and shear modulus = 0 [m].
  SparseMatrix volumetric_stiffness(const Eigen::VectorXd& element_weight) const;
  /// Replaces this matrix by the stiffness for any Lame parameters. It needs nothing else, because the part of the shear
  /// modulus is a sum of the same products of shape gradients.
  void make_elastic(double lambda, double mu, SparseMatrix& volumetric) const;

 private:
  void compute_gradients();
  void compute_pattern();
  template <typename Block>
  SparseMatrix assemble(const Eigen::VectorXd& element_weight, const Block& block) const;

  // Calls visit(element, the node's local number in it) for every element of the node.
  template <typename Visit>
  void for_each_corner(int node, const Visit& visit) const {
    const auto at = static_cast<std::size_t>(node);
    const int n = nodes_per_element();
    for (int k = corners_.first[at]; k < corners_.first[at + 1]; ++k) {
      const int corner = corners_.corners[static_cast<std::size_t>(k)];
      visit(corner / n, corner % n);
    }
  }
  // Returns where `slots_` holds the position of a block within its column.
  std::size_t slot(int e, int a, int b) const {
    const auto n = static_cast<std::size_t>(nodes_per_element());
    return (static_cast<std::size_t>(e) * n + static_cast<std::size_t>(b)) * n + static_cast<std::size_t>(a);
  }

  int node_count_ = 0;
  int points_ = 1;
  Eigen::MatrixXi elements_;
  Eigen::Matrix3Xd nodes_;
  std::vector<double> gradients_;
  Eigen::MatrixXd weights_;
  Eigen::Matrix3Xd positions_;
  SparseMatrix pattern_;
  NodeCorners corners_;  ///< corners in all elements
  std::vector<int> slots_;
};

/// Moves a matrix; Eigen 3 would copy a sparse matrix instead.
inline void move_matrix(SparseMatrix& to, SparseMatrix&& from) {
  to.swap(from);
}
inline std::shared_ptr<const SparseMatrix> share_matrix(SparseMatrix&& matrix) {
  auto out = std::make_shared<SparseMatrix>();
  move_matrix(*out, std::move(matrix));
  return out;
}

/// Computes to += scale * part. The non-zeros of `part` must lie in the pattern of `to`; the cost is proportional to them.
void add_scaled(SparseMatrix& to, double scale, const SparseMatrix& part);

/// Returns whether both matrices are identical bit for bit.
bool same_matrix(const SparseMatrix& a, const SparseMatrix& b);

/// These are the shape functions and their derivatives with respect to the barycentric coordinates (r, s, t) of a 4- or
/// 10-node tetrahedron, in the node order of TetMesh.
Eigen::VectorXd tet_shape(int nodes, const Eigen::Vector3d& rst);
Eigen::MatrixXd tet_shape_derivative(int nodes, const Eigen::Vector3d& rst);

}  // namespace tissue_stiffness
