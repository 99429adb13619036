#include "tissue_stiffness/filter/long_run_variance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tissue_stiffness {
namespace {

double autocovariance(const Eigen::VectorXd& series, Eigen::Index lag) {
  const Eigen::Index n = series.size();
  return series.head(n - lag).dot(series.tail(n - lag)) / static_cast<double>(n);
}

}  // namespace

double long_run_variance(const Eigen::VectorXd& series, int lags) {
  return std::max(0.0, long_run_covariance(series, lags)(0, 0));  // non-negative but for round-off
}

Eigen::MatrixXd long_run_covariance(const Eigen::MatrixXd& series, int lags) {
  const Eigen::Index n = series.rows();
  if (series.size() == 0 || lags < 0) throw std::invalid_argument("long-run variance needs a series and lags >= 0");
  Eigen::MatrixXd sum = series.transpose() * series;
  for (Eigen::Index lag = 1; lag <= std::min<Eigen::Index>(lags, n - 1); ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / (lags + 1.0);
    const Eigen::MatrixXd product = series.topRows(n - lag).transpose() * series.bottomRows(n - lag);
    sum += weight * (product + product.transpose());
  }
  return sum / static_cast<double>(n);
}

int bartlett_lags(const Eigen::VectorXd& series) {
  const Eigen::Index n = series.size();
  if (n < 2) return 0;
  const double variance = autocovariance(series, 0);
  if (!(variance > 0.0)) return 0;
  const double rho = std::clamp(autocovariance(series, 1) / variance, -0.97, 0.97);
  const double alpha = 4.0 * rho * rho / std::pow((1.0 - rho) * (1.0 + rho), 2);
  const double lags = 1.1447 * std::cbrt(alpha * static_cast<double>(n));
  return static_cast<int>(std::min(std::floor(lags), static_cast<double>(n - 1)));
}

}  // namespace tissue_stiffness
