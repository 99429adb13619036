#include "tissue_stiffness/diagnosis/scores.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "tissue_stiffness/filter/long_run_variance.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSame = 1e-9;  // sine of the angle below which directions are one
constexpr double kGone = 1e-6;  // a tangent of which less than this share is left says nothing of its own

constexpr double kNothing = 1e-18;  // variance, of all frames': the tangent leaves this one alone
constexpr Eigen::Index kFewestTerms = 4;
constexpr double kLongestMemory = 0.98;  // of an error, from frame to frame

constexpr Eigen::Index kRowsAtOnce = 512;  // of directions that are compared

constexpr double kBandwidth = 1.3;  // of the root of the number of frames, at least: Lazarus et al. 2018, sec. 3

// P(q F > wald) where the covariance of `q` scores came with the bandwidth b of the series: Sun 2014 (Journal of
// Econometrics 178), eq. 16-18, for the Bartlett kernel.
double fixed_b_p_value(double wald, double q, double b) {
  constexpr double mean = 1.0, square = 2.0 / 3.0;  // of the kernel
  const double dof = std::max(std::ceil(1.0 / (b * square)), q), second = dof - q + 1.0;
  const double shift = b * (mean + (q - 1.0) * square), widening = 0.5 * (std::exp(shift) + 1.0 + shift);
  const double f = wald / q * second / (dof * widening);
  return boost::math::ibeta(0.5 * second, 0.5 * q, second / (second + q * f));
}

int lags_for(const Eigen::MatrixXd& series) {
  const auto n = static_cast<int>(series.rows());
  int lags = static_cast<int>(kBandwidth * std::sqrt(n));
  for (Eigen::Index k = 0; k < series.cols(); ++k) lags = std::max(lags, bartlett_lags(series.col(k)));
  return std::min(lags, n - 1);
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& a) {
  if (a.cols() == 0) return a;
  Eigen::MatrixXd scaled = a;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const double norm = a.col(i).norm();
    if (norm > 0.0) scaled.col(i) /= norm;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(kSame);
  return qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), qr.rank());
}

}  // namespace

Scorer::Scorer(const Eigen::VectorXd& residual, const Eigen::MatrixXd& known, std::vector<Eigen::Index> offsets,
               double variance, const Eigen::VectorXd& doubt)
    : basis_(orthonormal(known)), offsets_(std::move(offsets)), variance_(std::max(1.0, variance)) {
  residual_ = project(residual);
  if (doubt.size() > 0) doubt_ = project(doubt);
}

Eigen::MatrixXd Scorer::project(const Eigen::MatrixXd& x) const {
  if (basis_.cols() == 0) return x;
  const Eigen::MatrixXd once = x - basis_ * (basis_.transpose() * x);
  return once - basis_ * (basis_.transpose() * once);
}

double Scorer::remaining(const Eigen::VectorXd& column) const {
  return project(column).norm() / std::sqrt(static_cast<double>(column.size()));
}

// An error remembers the last frame's, e_t = m e_t-1 + n_t. So sum_t x_t^T e_t = sum_t z_t^T n_t with z_t = x_t + m z_t+1,
// whose terms are not correlated if that is all that is remembered; the HAC covariance sees the rest. It is taken of terms
// of unit variance: an effect that acts for a short while is judged by the errors of all frames.
Scorer::Terms Scorer::terms(const Eigen::MatrixXd& x, const Eigen::VectorXd& left) const {
  const double memory = memory_of(left);
  Eigen::MatrixXd z = x;
  Eigen::VectorXd news = left;
  Eigen::VectorXd fresh = Eigen::VectorXd::Ones(frames());  // variance of n_t, of that of e_t
  for (Eigen::Index t = frames() - 1; t > 0; --t) {
    if (count(t) != count(t - 1)) continue;
    z.middleRows(offset(t - 1), count(t - 1)) += memory * z.middleRows(offset(t), count(t));
    news.segment(offset(t), count(t)) -= memory * left.segment(offset(t - 1), count(t - 1));
    fresh[t] = 1.0 - memory * memory;
  }
  Terms out{Eigen::MatrixXd(frames(), x.cols()), 0.0};
  Eigen::Index n = 0;
  for (Eigen::Index t = 0; t < frames(); ++t) {
    const auto rows = z.middleRows(offset(t), count(t));
    const double variance = fresh[t] * rows.squaredNorm() / static_cast<double>(x.cols());
    if (!(variance > kNothing)) continue;
    out.unit.row(n++) = news.segment(offset(t), count(t)).transpose() * rows / std::sqrt(variance);
    out.variance += variance;
  }
  out.unit.conservativeResize(n, Eigen::NoChange);
  return out;
}

double Scorer::p_value(const Eigen::MatrixXd& x, const Eigen::VectorXd& left) const {
  const Terms series = terms(x, left);
  const Eigen::Index n = series.unit.rows();
  if (n < kFewestTerms) return 1.0;
  const int lags = lags_for(series.unit);
  Eigen::MatrixXd covariance = series.variance * long_run_covariance(series.unit, lags);
  if (doubt_.size() > 0) {
    const Eigen::VectorXd may_be = x.transpose() * doubt_;
    covariance += may_be * may_be.transpose();
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
  if (!factor.isPositive() || !(factor.vectorD().minCoeff() > 0.0)) return 1.0;
  const Eigen::VectorXd sum = x.transpose() * residual_;
  return fixed_b_p_value(sum.dot(factor.solve(sum)), static_cast<double>(x.cols()), (lags + 1.0) / static_cast<double>(n));
}

// Correlation of an error with that of the same row a frame later.
double Scorer::memory_of(const Eigen::VectorXd& left) const {
  double products = 0.0, squares = 0.0;
  for (Eigen::Index t = 0; t + 1 < frames(); ++t) {
    if (count(t + 1) != count(t)) continue;
    const auto now = left.segment(offset(t), count(t)), next = left.segment(offset(t + 1), count(t));
    products += now.dot(next);
    squares += 0.5 * (now.squaredNorm() + next.squaredNorm());
  }
  return squares > 0.0 ? std::clamp(products / squares, 0.0, kLongestMemory) : 0.0;
}

Score Scorer::score(const Tangent& tangent) const {
  return score(tangent, true);
}

Score Scorer::score(const Tangent& tangent, bool with_p_value) const {
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
    if (with_p_value) out.p_value = p_value(orthonormal(x), residual_ - fit);
  }
  return out;
}

Score Scorer::score(const Tangent& a, const Tangent& b) const {
  Tangent both;
  both.columns.resize(a.columns.rows(), a.columns.cols() + b.columns.cols());
  both.columns << a.columns, b.columns;
  both.prior_std.resize(a.prior_std.size() + b.prior_std.size());
  both.prior_std << a.prior_std, b.prior_std;
  return score(both, false);
}

double Score::cosine_with(const Score& other) const {
  return std::abs(direction.dot(other.direction));
}

double combined_p_value(const std::vector<const Score*>& ways) {
  std::vector<const Score*> telling;
  double best = 1.0;
  for (const Score* way : ways) {
    if (way->direction.isZero(0.0)) continue;
    telling.push_back(way);
    best = std::min(best, way->p_value);
  }
  const auto count = static_cast<Eigen::Index>(telling.size());
  if (count < 2) return best;
  const Eigen::Index rows = telling.front()->direction.size();
  Eigen::MatrixXd cosines = Eigen::MatrixXd::Zero(count, count), part(kRowsAtOnce, count);
  for (Eigen::Index at = 0; at < rows; at += kRowsAtOnce) {
    const Eigen::Index height = std::min(kRowsAtOnce, rows - at);
    for (Eigen::Index i = 0; i < count; ++i) {
      part.col(i).head(height) = telling[static_cast<std::size_t>(i)]->direction.segment(at, height);
    }
    cosines.selfadjointView<Eigen::Lower>().rankUpdate(part.topRows(height).transpose());
  }
  const Eigen::VectorXd values = cosines.selfadjointView<Eigen::Lower>().eigenvalues().cwiseMax(0.0);
  const double roots = values.cwiseSqrt().sum(), tests = roots * roots / values.sum();
  return -std::expm1(tests * std::log1p(-std::min(best, 1.0 - 1e-15)));
}

double prediction_p_value(const Eigen::VectorXd& gains) {
  if (gains.size() < 2) return 1.0;
  const double n = static_cast<double>(gains.size()), mean = gains.mean();
  const Eigen::VectorXd around = gains.array() - mean;
  const int lags = lags_for(around);
  const double variance = long_run_variance(around, lags) / n;
  if (!(variance > 0.0)) return mean > 0.0 ? 0.0 : 1.0;
  const double both_sides = fixed_b_p_value(mean * mean / variance, 1.0, (lags + 1.0) / n);
  return mean > 0.0 ? 0.5 * both_sides : 1.0 - 0.5 * both_sides;
}

double log_mean_exp(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const double largest = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - largest);
  return largest + std::log(sum / static_cast<double>(values.size()));
}

}  // namespace tissue_stiffness
