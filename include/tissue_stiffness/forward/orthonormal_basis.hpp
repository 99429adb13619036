#pragma once

#include <Eigen/Core>
#include <cmath>

#include "tissue_stiffness/fem/discretisation.hpp"

namespace tissue_stiffness {

/// Gram-Schmidt, twice, in the inner product of M.
class OrthonormalBasis {
 public:
  OrthonormalBasis(const SparseMatrix& mass, Eigen::Index capacity)
      : mass_(mass), vectors_(mass.rows(), capacity), weighted_(mass.rows(), capacity) {}

  bool full() const { return size_ == vectors_.cols(); }
  Eigen::Index size() const { return size_; }
  auto vectors() const { return vectors_.leftCols(size_); }

  /// What is left of the columns of x beside the basis.
  Eigen::MatrixXd beside(Eigen::MatrixXd x) const {
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::MatrixXd share = weighted_.leftCols(size_).transpose() * x;
      x.noalias() -= vectors() * share;
    }
    return x;
  }

  /// False when the basis is full or x no new direction.
  bool add(const Eigen::VectorXd& x) {
    constexpr double dependent = 1e-7;  // of its norm: what a new direction keeps at least
    if (full()) return false;
    const double before = std::sqrt(x.dot(mass_ * x));
    if (!(before > 0.0)) return false;
    const Eigen::VectorXd rest = beside(x / before);
    const Eigen::VectorXd weighted = mass_ * rest;
    const double after = std::sqrt(rest.dot(weighted));
    if (!(after > dependent)) return false;
    vectors_.col(size_) = rest / after;
    weighted_.col(size_++) = weighted / after;
    return true;
  }

 private:
  const SparseMatrix& mass_;
  Eigen::MatrixXd vectors_, weighted_;  // the second: M times the first
  Eigen::Index size_ = 0;
};

}  // namespace tissue_stiffness
