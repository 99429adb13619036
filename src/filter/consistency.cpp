#include "filter/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double precision = std::numeric_limits<double>::epsilon();
constexpr int most_terms = 10000000;

/// Returns x^a e^-x / Gamma(a + 1), the common factor of both expansions, without overflow.
double gamma_density(double a, double x) {
  return std::exp(a * std::log(x) - x - std::lgamma(a + 1.0));
}

/// Returns the sum of x^n / ((a+1)...(a+n)). It converges fast for x < a + 1 (Abramowitz, Stegun 6.5.29).
double lower_series(double a, double x) {
  double term = 1.0, sum = 1.0;
  for (int n = 1; n < most_terms && term > precision * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return gamma_density(a, x) * sum;
}

/// Returns the continued fraction of the upper function by Lentz' method. It converges fast for x >= a + 1 (Abramowitz,
/// Stegun 6.5.31).
double upper_fraction(double a, double x) {
  constexpr double tiny = 1e-300;
  double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, fraction = d;
  for (int n = 1; n < most_terms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = numerator * d + b;
    c = b + numerator / c;
    if (std::abs(d) < tiny) d = tiny;
    if (std::abs(c) < tiny) c = tiny;
    d = 1.0 / d;
    fraction *= c * d;
    if (std::abs(c * d - 1.0) < precision) break;
  }
  return gamma_density(a, x) * a * fraction;
}

/// P and 1 - P, each to full relative precision.
struct Tails {
  double lower, upper;
};
Tails gamma_tails(double a, double x) {
  if (!(a > 0.0) || !(x >= 0.0)) throw std::invalid_argument("incomplete gamma function needs a > 0 and x >= 0");
  if (x == 0.0) return {0.0, 1.0};
  if (std::isinf(x)) return {1.0, 0.0};
  if (x < a + 1.0) {
    const double lower = std::min(1.0, lower_series(a, x));
    return {lower, 1.0 - lower};
  }
  const double upper = std::min(1.0, upper_fraction(a, x));
  return {1.0 - upper, upper};
}

}  // namespace

double normalised_squared(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (cholesky.info() != Eigen::Success) throw NumericalError("the covariance of an error is not positive definite");
  return cholesky.matrixL().solve(error).squaredNorm();
}

double incomplete_gamma(double a, double x) {
  return gamma_tails(a, x).lower;
}

double chi_squared_cdf(double x, double dof) {
  return x <= 0.0 ? 0.0 : gamma_tails(0.5 * dof, 0.5 * x).lower;
}

double chi_squared_upper(double x, double dof) {
  return x <= 0.0 ? 1.0 : gamma_tails(0.5 * dof, 0.5 * x).upper;
}

double chi_squared_quantile(double p, double dof) {
  if (!(p > 0.0 && p < 1.0 && dof > 0.0)) throw std::invalid_argument("chi-squared quantile needs 0 < p < 1 and dof > 0");
  double low = 0.0, high = dof + 1.0;
  while (chi_squared_cdf(high, dof) < p) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 2.0 * precision * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi_squared_cdf(middle, dof) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double two_sided_p_value(double sum_of_squares, double dof) {
  const Tails tails = gamma_tails(0.5 * dof, 0.5 * sum_of_squares);
  return std::min(1.0, 2.0 * std::min(tails.lower, tails.upper));
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

}  // namespace tissue_stiffness
