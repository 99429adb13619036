#pragma once

namespace tissue_stiffness {

/// Half width of the central 95 % interval of a standard normal variable.
constexpr double normal_quantile_975 = 1.959963984540054;

/// A quantity's mean, standard deviation and central 95 % interval, in its own unit.
struct Interval {
  double mean = 0.0;
  double std = 0.0;
  double lower95 = 0.0;
  double upper95 = 0.0;
};

/// Returns the interval of N(mean, variance).
Interval normal_interval(double mean, double variance);

/// Returns the interval of x with log x ~ N(log_mean, log_variance): mean exp(m + v/2), std mean sqrt(e^v - 1), interval
/// exp(m -+ 1.96 sqrt v).
Interval log_normal_interval(double log_mean, double log_variance);

}  // namespace tissue_stiffness
