#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Returns S X of a symmetric S (n x n, both triangles stored) and X (n x m). The rows are computed in parallel and
/// independently, so the result does not depend on the number of cores.
Eigen::MatrixXd symmetric_product(const SparseMatrix& s, const Eigen::MatrixXd& x);

/// Computes y -= S x for one vector in place.
void subtract_product(const SparseMatrix& s, const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& y);

/// Returns A^T B of tall A (n x p) and B (n x q), with the widest instructions of the machine. It sums over fixed blocks of
/// rows, so the result does not depend on the number of cores.
Eigen::MatrixXd inner_products(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b);

/// Sum of A^T A over successive blocks of rows. It is not thread safe.
class GramSum {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit GramSum(Eigen::Index columns) : sum_(Eigen::MatrixXd::Zero(columns, columns)) {}
  /// Adds the first `count` rows of a.
  void add(const Rows& a, Eigen::Index count);
  const Eigen::MatrixXd& sum() const { return sum_; }

 private:
  Eigen::MatrixXd sum_;
};

/// A (n x p), stored in the order in which its products read it, with the widest instructions of the machine. It is for a
/// matrix that is multiplied by few columns repeatedly.
class PackedMatrix {
 public:
  PackedMatrix() = default;
  explicit PackedMatrix(const Eigen::Ref<const Eigen::MatrixXd>& a);

  Eigen::Index rows() const { return rows_; }
  /// Computes out = A x. The rows are computed in parallel and independently, so the result does not depend on the number
  /// of cores.
  void multiply(const Eigen::MatrixXd& x, Eigen::Ref<Eigen::MatrixXd> out) const;
  Eigen::MatrixXd operator*(const Eigen::MatrixXd& x) const;

 private:
  Eigen::Index rows_ = 0, columns_ = 0;
  std::vector<double> panels_;
};

}  // namespace tissue_stiffness
