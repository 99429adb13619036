#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Newey-West (1987) estimate of the long-run variance of a series: gamma_0 + 2 sum_{l=1}^{lags} (1 - l / (lags + 1))
/// gamma_l with gamma_l = 1/n sum_t g_t g_{t-l}. n times it is the variance of the series' sum, however its values are
/// correlated in time; never negative. The series is taken as it is: subtract its mean first where that is not zero by
/// hypothesis.
double long_run_variance(const Eigen::VectorXd& series, int lags);

/// The same of vectors: `series` is n x k, the result k x k.
Eigen::MatrixXd long_run_covariance(const Eigen::MatrixXd& series, int lags);

/// Bandwidth of Andrews (1991) for the Bartlett kernel, from the series' first autocorrelation rho:
/// 1.1447 (4 rho^2 n / ((1 - rho)^2 (1 + rho)^2))^(1/3), at most n - 1.
int bartlett_lags(const Eigen::VectorXd& series);

}  // namespace tissue_stiffness
