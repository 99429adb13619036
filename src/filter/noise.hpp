#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// Covariance R of a measurement's noise, stored as a square root B with R = B B^T.
class Noise {
 public:
  /// Noise of independent rows with the given standard deviations. Throws std::invalid_argument unless all are > 0.
  /// Infinity is allowed: such a row is ignored.
  static Noise independent(Eigen::VectorXd sigma);

  /// Noise with a full covariance. Throws NumericalError unless it is positive definite.
  static Noise correlated(const Eigen::MatrixXd& covariance);

  Eigen::Index size() const { return diagonal_ ? sigma_.size() : factor_.rows(); }
  bool usable(Eigen::Index row) const;

  /// Returns B^-1 columns.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const;
  double log_determinant() const;    ///< log of the determinant of R
  Eigen::VectorXd variance() const;  ///< diagonal of R
  Noise rows(const std::vector<Eigen::Index>& indices) const;

 private:
  bool diagonal_ = true;
  Eigen::VectorXd sigma_;   ///< diagonal B
  Eigen::MatrixXd factor_;  ///< lower triangular B
};

}  // namespace tissue_stiffness
