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
  if (series.size() == 0 || lags < 0) throw std::invalid_argument("long-run variance needs a series and lags >= 0");
  double variance = autocovariance(series, 0);
  const Eigen::Index last = std::min<Eigen::Index>(lags, series.size() - 1);
  for (Eigen::Index lag = 1; lag <= last; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / (lags + 1.0);
    variance += 2.0 * weight * autocovariance(series, lag);
  }
  return std::max(0.0, variance);  // non-negative but for round-off
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
