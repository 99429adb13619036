#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

namespace tissue_stiffness {

/// Returns x with the least |A x - b|; zeros for A = 0, of which Eigen's decomposition makes no numbers.
inline Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  if (a.isZero(0.0)) return Eigen::VectorXd::Zero(a.cols());
  return a.colPivHouseholderQr().solve(b);
}

}  // namespace tissue_stiffness
