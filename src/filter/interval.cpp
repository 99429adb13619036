#include "filter/interval.hpp"

#include <cmath>

namespace tissue_stiffness {

Interval normal_interval(double mean, double variance) {
  const double std = std::sqrt(variance);
  return {mean, std, mean - normal_quantile_975 * std, mean + normal_quantile_975 * std};
}

Interval log_normal_interval(double log_mean, double log_variance) {
  const double reach = normal_quantile_975 * std::sqrt(log_variance);
  const double mean = std::exp(log_mean + 0.5 * log_variance);
  return {mean, mean * std::sqrt(std::expm1(log_variance)), std::exp(log_mean - reach), std::exp(log_mean + reach)};
}

}  // namespace tissue_stiffness
