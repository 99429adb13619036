#include "diagnosis/scores.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "filter/consistency.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSame = 1e-9;  // sine of the angle below which directions are one
constexpr double kFar = 30.0;   // standard deviations beyond which the tail's asymptote is exact; it underflows soon after
constexpr int kBisections = 60;
constexpr double kGone = 1e-6;           // share of a tangent: with less left it says nothing of its own
constexpr double kNearlyCertain = 1e-3;  // -log of a p-value below which its terms cancel

// Returns log P(Z >= z).
double log_upper_tail(double z) {
  return z < kFar ? std::log(normal_cdf(-z)) : -0.5 * z * z - std::log(z * std::sqrt(2.0 * M_PI));
}

// Returns the z >= 0 with that log P(Z >= z). The tail falls as steeply as a parabola, so bisection finds it.
double upper_quantile(double log_p) {
  double low = 0.0, high = std::sqrt(-2.0 * log_p);
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (log_upper_tail(middle) > log_p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  if (columns.size() == 0) return Eigen::MatrixXd(columns.rows(), 0);
  Eigen::MatrixXd scaled = columns;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double norm = columns.col(i).norm();
    if (norm > 0.0) scaled.col(i) /= norm;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(kSame);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

Scorer::Scorer(const Eigen::VectorXd& residual, const Eigen::MatrixXd& nuisance_tangents, double variance)
    : basis_(orthonormal(nuisance_tangents)), variance_(variance) {
  residual_ = project(residual);
}

Eigen::MatrixXd Scorer::project(const Eigen::MatrixXd& x) const {
  if (basis_.cols() == 0) return x;
  const Eigen::MatrixXd once = x - basis_ * (basis_.transpose() * x);
  return once - basis_ * (basis_.transpose() * once);
}

Score Scorer::score(const Tangent& tangent) const {
  Score out;
  const Eigen::Index components = tangent.columns.cols();
  out.direction = Eigen::VectorXd::Zero(residual_.size());
  out.amplitude = Eigen::VectorXd::Zero(components);
  const Eigen::MatrixXd x = project(tangent.columns);
  if (!x.allFinite() || x.norm() <= kGone * tangent.columns.norm()) return out;
  const Eigen::MatrixXd scaled = x * tangent.prior_std.asDiagonal();
  const Eigen::MatrixXd gram = scaled.transpose() * scaled / variance_;
  const Eigen::VectorXd b = scaled.transpose() * residual_ / variance_;
  const Eigen::LLT<Eigen::MatrixXd> posterior(Eigen::MatrixXd::Identity(components, components) + gram);
  out.log_bayes_factor = 0.5 * b.dot(posterior.solve(b)) - posterior.matrixLLT().diagonal().array().log().sum();
  out.amplitude = tangent.prior_std.cwiseProduct(
      (gram + 1e-12 * gram.trace() * Eigen::MatrixXd::Identity(components, components)).ldlt().solve(b));
  const Eigen::VectorXd fit = x * out.amplitude;
  out.explained = residual_.squaredNorm() - (residual_ - fit).squaredNorm();
  if (fit.norm() > 0.0) out.direction = fit.normalized();
  return out;
}

double Score::cosine_with(const Score& other) const {
  return std::abs(direction.dot(other.direction));
}

double log_mean_exp(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const double largest = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - largest);
  return largest + std::log(sum / static_cast<double>(values.size()));
}

double likelihood_ratio_p_value(double gain, double parameters) {
  return chi_squared_upper(gain, std::max(1.0, parameters));
}

double averaged_z(const std::vector<double>& z) {
  std::vector<double> log_above, log_below;
  for (const double one : z) {
    log_above.push_back(log_upper_tail(one));
    log_below.push_back(log_upper_tail(-one));
  }
  const double above = log_mean_exp(log_above), below = log_mean_exp(log_below);
  return above < below ? upper_quantile(above) : -upper_quantile(below);  // the smaller one is exact
}

double log_bayes_factor_of_test(double z) {
  const double l = -log_upper_tail(z);
  if (l < kNearlyCertain) return std::log(0.5 + l / 6.0);  // its series, because the terms below cancel
  return l - 2.0 * std::log(l) + std::log1p(-(1.0 + l) * std::exp(-l));
}

double believed_gain(double whole, double modal, double z) {
  return std::min(whole, std::max(log_bayes_factor_of_test(z), modal));
}

}  // namespace tissue_stiffness
