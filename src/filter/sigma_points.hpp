#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Tuning of the scaled unscented set. The paper (Yang, Lin 2016) uses beta = 2 and alpha from 0.1 to 2.
struct UnscentedTuning {
  double alpha = 1.0;  ///< spread of the points, > 0
  double beta = 2.0;   ///< 2 is best for a Gaussian, >= 0
  double kappa = 0.0;  ///< >= 0
};

/// Mean and square root of the covariance of a model's outputs at the sigma points: covariance = linear linear^T +
/// remainder remainder^T. The covariance with the model's input is S linear^T (S: square root of the input's covariance).
/// It is a sum of squares, so it cannot become indefinite.
struct UnscentedMoments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd linear;     ///< m x L: statistically linearised model times S
  Eigen::MatrixXd remainder;  ///< m x L or m x 0: remainder beyond the linear part
};

/// Sigma points of a standard normal variable in L dimensions. Points of N(mean, S S^T) are mean + S unit.
class SigmaSet {
 public:
  /// Returns 2L + 1 points, eq. 13-15: 0, +gamma e_i, -gamma e_i with gamma = sqrt(L + lambda), lambda = alpha^2 (L +
  /// kappa) - L. Throws std::invalid_argument for L < 1 or a tuning out of range.
  static SigmaSet scaled(int dimension, const UnscentedTuning& tuning);

  /// Returns L + 1 points of equal weight on a regular simplex (as in Moireau, Chapelle 2011, ESAIM COCV 17:380). They cost
  /// half as much, but a quadratic model's covariance is less exact than with the scaled set.
  static SigmaSet simplex(int dimension);

  const Eigen::MatrixXd& unit() const { return unit_; }                              ///< L x points
  const Eigen::VectorXd& mean_weights() const { return mean_weights_; }              ///< omega^(m), sums to 1
  const Eigen::VectorXd& covariance_weights() const { return covariance_weights_; }  ///< omega^(c), eq. 15 as printed

  /// Returns the sigma points of eq. 13, 14. `square_root` is L x L.
  Eigen::MatrixXd points(const Eigen::VectorXd& mean, const Eigen::MatrixXd& square_root) const;

  /// Returns the moments of the model's output, one column for each sigma point (eq. 18 to 20 without R).
  UnscentedMoments moments(const Eigen::MatrixXd& output) const;

 private:
  Eigen::MatrixXd unit_;
  Eigen::VectorXd mean_weights_, covariance_weights_;
  bool symmetric_ = true;
  UnscentedTuning tuning_;
};

/// Returns the lower triangular L with non-negative diagonal and L L^T = columns columns^T. QR avoids squaring the
/// condition number.
Eigen::MatrixXd lower_square_root(const Eigen::MatrixXd& columns);

}  // namespace tissue_stiffness
