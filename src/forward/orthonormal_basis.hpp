#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/products.hpp"

namespace tissue_stiffness {

/// Basis that is orthonormal in the inner product of M (compressed), by Gram-Schmidt applied twice.
class OrthonormalBasis {
 public:
  OrthonormalBasis(const SparseMatrix& mass, Eigen::Index capacity)
      : mass_(mass), vectors_(mass.rows(), capacity), weighted_(mass.rows(), capacity) {}

  Eigen::Index size() const { return size_; }
  auto vectors() const { return vectors_.leftCols(size_); }
  /// Returns M times the vectors.
  auto weighted() const { return weighted_.leftCols(size_); }

  /// Starts with vectors that are already orthonormal, and M times them.
  void begin(const Eigen::MatrixXd& vectors, const Eigen::MatrixXd& weighted) {
    size_ = vectors.cols();
    vectors_.leftCols(size_) = vectors;
    weighted_.leftCols(size_) = weighted;
  }

  /// Returns the columns of x less their projection onto the basis.
  Eigen::MatrixXd beside(Eigen::MatrixXd x) const { return off(0, std::move(x)); }

  /// Adds the columns' new directions, until there are at most `size` vectors.
  void add(Eigen::MatrixXd x, Eigen::Index size) {
    const Eigen::Index before = size_, most = std::min(size, vectors_.cols());
    const Eigen::RowVectorXd norms = (x.array() * symmetric_product(mass_, x).array()).colwise().sum().sqrt();
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (norms[i] > 0.0) x.col(i) /= norms[i];
    }
    x = beside(std::move(x));
    for (Eigen::Index at = 0; at < x.cols() && size_ < most; at += kBlock) {
      const Eigen::Index count = std::min(kBlock, x.cols() - at), first = size_;
      const Eigen::MatrixXd block = off(before, x.middleCols(at, count)), weighted = symmetric_product(mass_, block);
      for (Eigen::Index i = 0; i < count && size_ < most; ++i) {
        if (norms[at + i] > 0.0) add_one(block.col(i), weighted.col(i), first);
      }
    }
  }

 private:
  static constexpr Eigen::Index kBlock = 12;  // columns from which earlier ones are subtracted together

  // Returns the columns of x less their projection onto the vectors from `first` on.
  Eigen::MatrixXd off(Eigen::Index first, Eigen::MatrixXd x) const {
    if (first == size_) return x;
    for (int pass = 0; pass < 2; ++pass) {
      x.noalias() -=
          vectors_.middleCols(first, size_ - first) * inner_products(weighted_.middleCols(first, size_ - first), x);
    }
    return x;
  }

  // x is already orthogonal to the first `before` vectors; weighted: M x.
  void add_one(Eigen::VectorXd x, Eigen::VectorXd weighted, Eigen::Index before) {
    constexpr double dependent = 1e-7;  // least share of its norm that a new direction keeps
    constexpr double cancelled = 1e-3;  // below this share of the norm, M x has lost digits
    const double whole = x.dot(weighted);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd share = weighted_.middleCols(before, size_ - before).transpose() * x;
      x.noalias() -= vectors_.middleCols(before, size_ - before) * share;
      weighted.noalias() -= weighted_.middleCols(before, size_ - before) * share;
    }
    if (!(x.dot(weighted) > cancelled * cancelled * whole)) weighted = symmetric_product(mass_, x);
    const double norm = std::sqrt(x.dot(weighted));
    if (!(norm > dependent)) return;
    vectors_.col(size_) = x / norm;
    weighted_.col(size_++) = weighted / norm;
  }

  const SparseMatrix& mass_;
  Eigen::MatrixXd vectors_, weighted_;  // weighted_: M times vectors_
  Eigen::Index size_ = 0;
};

}  // namespace tissue_stiffness
