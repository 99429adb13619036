#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// Tells the noise of a signal from how far each value is from the line between its neighbours in time. A signal that is
/// smooth from one value to the next hardly counts, so no model of it is needed. With a = (t_k+1 - t_k) / (t_k+1 - t_k-1),
/// b = 1 - a,
///   r_k = (a y_k-1 + b y_k+1 - y_k) / sqrt(a^2 + b^2 + 1),   variance = mean of r_k^2
/// (Gasser, Sroka & Jennen-Steinmetz 1986, Biometrika 73, eq. 2.2). Outliers get robust weights (filter/robust_weights).
class DifferenceNoise {
 public:
  /// Takes the next value, over its stated noise. Values at times that do not grow, or that are not finite, count nowhere.
  void add(double time, const Eigen::VectorXd& value);
  /// Returns the variance of one component over the stated one; infinity where fewer than three values are known.
  double variance() const;
  /// Returns a weight for each value that was added: 1, or less for what its neighbours contradict.
  Eigen::VectorXd weights() const;

 private:
  Eigen::MatrixXd residuals() const;

  std::vector<double> times_;
  std::vector<Eigen::VectorXd> values_;
  std::vector<Eigen::Index> numbers_;  ///< of these among all that were added
  Eigen::Index added_ = 0;
};

}  // namespace tissue_stiffness
