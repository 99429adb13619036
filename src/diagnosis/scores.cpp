#include "tissue_stiffness/diagnosis/scores.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "tissue_stiffness/filter/consistency.hpp"
#include "tissue_stiffness/filter/long_run_variance.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kGone = 1e-6;  // a tangent of which less than this share is left says nothing of its own

constexpr double kBandwidth = 1.3;  // of the root of the number of frames, at least: Lazarus et al. 2018, sec. 3

// How much wider than the normal's the statistic is when the bandwidth is the share b of the series: Kiefer & Vogelsang
// 2005, table 1, Bartlett kernel at 5 %.
double fixed_b_widening(double b) {
  return (1.96 + b * (2.9694 + b * (0.4160 - 0.5324 * b))) / 1.96;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& a) {
  if (a.cols() == 0) return a;
  Eigen::MatrixXd scaled = a;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const double norm = a.col(i).norm();
    if (norm > 0.0) scaled.col(i) /= norm;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  return qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), qr.rank());
}

}  // namespace

Scorer::Scorer(const Eigen::VectorXd& residual, const Eigen::MatrixXd& known, std::vector<Eigen::Index> offsets,
               double variance)
    : basis_(orthonormal(known)), offsets_(std::move(offsets)), variance_(std::max(1.0, variance)) {
  residual_ = project(residual);
}

Eigen::MatrixXd Scorer::project(const Eigen::MatrixXd& x) const {
  if (basis_.cols() == 0) return x;
  const Eigen::MatrixXd once = x - basis_ * (basis_.transpose() * x);
  return once - basis_ * (basis_.transpose() * once);
}

double Scorer::remaining(const Eigen::VectorXd& column) const {
  return project(column).norm() / std::sqrt(static_cast<double>(column.size()));
}

double Scorer::p_value(const Eigen::VectorXd& x, const Eigen::VectorXd& left) const {
  const auto frames = static_cast<Eigen::Index>(offsets_.size()) - 1;
  Eigen::VectorXd g(frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index from = offsets_[static_cast<std::size_t>(t)],
                       count = offsets_[static_cast<std::size_t>(t) + 1] - from;
    g[t] = x.segment(from, count).dot(left.segment(from, count));
  }
  const double n = static_cast<double>(frames);
  const int lags =
      std::min(std::max(bartlett_lags(g), static_cast<int>(kBandwidth * std::sqrt(n))), static_cast<int>(n) - 1);
  const double variance = n * long_run_variance(g, lags);
  if (!(variance > 0.0)) return 1.0;
  const double z = x.dot(residual_) / std::sqrt(variance);
  return 2.0 * (1.0 - normal_cdf(std::abs(z) / fixed_b_widening((lags + 1.0) / n)));
}

Score Scorer::score(const Tangent& tangent) const {
  Score out;
  const Eigen::Index n = residual_.size(), components = tangent.columns.cols();
  out.direction = Eigen::VectorXd::Zero(n);
  out.amplitude = Eigen::VectorXd::Zero(components);
  const Eigen::MatrixXd x = project(tangent.columns);
  if (!x.allFinite() || x.norm() <= kGone * tangent.columns.norm()) return out;
  const Eigen::MatrixXd scaled = x * tangent.prior_std.asDiagonal();
  const Eigen::MatrixXd gram = scaled.transpose() * scaled / variance_;
  const Eigen::VectorXd b = scaled.transpose() * residual_ / variance_;
  const Eigen::LLT<Eigen::MatrixXd> posterior(Eigen::MatrixXd::Identity(components, components) + gram);
  const Eigen::VectorXd mean = posterior.solve(b);
  out.log_bayes_factor = 0.5 * b.dot(mean) - posterior.matrixLLT().diagonal().array().log().sum();
  out.amplitude = tangent.prior_std.cwiseProduct(
      (gram + 1e-12 * gram.trace() * Eigen::MatrixXd::Identity(components, components)).ldlt().solve(b));
  const Eigen::VectorXd fit = x * out.amplitude;
  out.size = fit.norm() / std::sqrt(static_cast<double>(n));
  out.explained = 1.0 - (residual_ - fit).squaredNorm() / residual_.squaredNorm();
  if (fit.norm() > 0.0) {
    out.direction = fit.normalized();
    out.p_value = std::min(1.0, static_cast<double>(components) * p_value(fit, residual_ - fit));
  }
  return out;
}

Score Scorer::score(const Tangent& a, const Tangent& b) const {
  Tangent both;
  both.columns.resize(a.columns.rows(), a.columns.cols() + b.columns.cols());
  both.columns << a.columns, b.columns;
  both.prior_std.resize(a.prior_std.size() + b.prior_std.size());
  both.prior_std << a.prior_std, b.prior_std;
  return score(both);
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

}  // namespace tissue_stiffness
