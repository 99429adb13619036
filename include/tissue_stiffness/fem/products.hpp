#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/fem/discretisation.hpp"

namespace tissue_stiffness {

/// S X of a symmetric S (n x n, both triangles stored) and X (n x m). Rows of the result are independent of each other: in
/// parallel, and the same whatever the number of cores.
Eigen::MatrixXd symmetric_product(const SparseMatrix& s, const Eigen::MatrixXd& x);

/// y -= S x for one vector, in place.
void subtract_product(const SparseMatrix& s, const Eigen::VectorXd& x, Eigen::VectorXd& y);

/// A^T B of tall A (n x p) and B (n x q), in the widest instructions of the machine; sums of fixed blocks of rows, so that
/// the result does not depend on the number of cores.
Eigen::MatrixXd inner_products(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b);

/// Sum of A^T A over blocks of rows as they come. Not thread safe.
class GramSum {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit GramSum(Eigen::Index columns) : sum_(Eigen::MatrixXd::Zero(columns, columns)) {}
  /// The first `count` rows of a.
  void add(const Rows& a, Eigen::Index count);
  const Eigen::MatrixXd& sum() const { return sum_; }

 private:
  Eigen::MatrixXd sum_;
};

/// A (n x p) kept in the order in which its products read it, in the widest instructions of the machine: for a matrix that
/// is multiplied by few columns, again and again.
class PackedMatrix {
 public:
  PackedMatrix() = default;
  explicit PackedMatrix(const Eigen::Ref<const Eigen::MatrixXd>& a);

  Eigen::Index rows() const { return rows_; }
  /// out = A x. Rows of the result are independent of each other: in parallel, and the same whatever the number of cores.
  void multiply(const Eigen::MatrixXd& x, Eigen::Ref<Eigen::MatrixXd> out) const;
  Eigen::MatrixXd operator*(const Eigen::MatrixXd& x) const;

 private:
  Eigen::Index rows_ = 0, columns_ = 0;
  std::vector<double> panels_;
};

}  // namespace tissue_stiffness
