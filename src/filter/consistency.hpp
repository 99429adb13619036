#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Returns e^T P^-1 e. It is the normalised innovation squared (NIS) for an innovation and its covariance, and the
/// normalised estimation error squared (NEES) for an estimate's error and its covariance. It is chi-squared with e.size()
/// degrees of freedom when P is right (Bar-Shalom, Li, Kirubarajan 2001, section 5.4). Throws NumericalError unless P is
/// positive definite.
double normalised_squared(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

/// Returns the lower regularised incomplete gamma function P(a, x), a > 0, x >= 0.
double incomplete_gamma(double a, double x);

/// Returns P(chi^2_dof <= x). `dof` > 0 need not be an integer.
double chi_squared_cdf(double x, double dof);

/// Returns P(chi^2_dof > x), to full relative precision where it is small.
double chi_squared_upper(double x, double dof);

/// Returns the inverse of chi_squared_cdf for 0 < p < 1.
double chi_squared_quantile(double p, double dof);

/// Returns twice the probability of a sum of squares that is at least as extreme on the same side. It is small for an
/// overconfident filter (the sum is too large) and for an underconfident one (the sum is too small).
double two_sided_p_value(double sum_of_squares, double dof);

/// Returns P(z <= x) for a standard normal z.
double normal_cdf(double x);

/// Sum of the NIS over frames.
struct ConsistencySum {
  double sum = 0.0;
  double dof = 0.0;

  void add(double nis, int rows) {
    sum += nis;
    dof += rows;
  }
  /// Returns the mean per row, which is 1 for a consistent filter; NaN before the first row.
  double mean_per_dof() const { return sum / dof; }
  /// Returns the two-sided p-value; 1 before the first row.
  double p_value() const { return dof > 0.0 ? two_sided_p_value(sum, dof) : 1.0; }
};

}  // namespace tissue_stiffness
