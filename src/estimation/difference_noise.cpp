#include "estimation/difference_noise.hpp"

#include <cmath>
#include <limits>

#include "filter/robust_weights.hpp"

namespace tissue_stiffness {
namespace {

Eigen::VectorXd weights_of(const Eigen::MatrixXd& residuals) {
  const Eigen::VectorXd rows = Eigen::Map<const Eigen::VectorXd>(residuals.data(), residuals.size());
  return robust_weights(rows, static_cast<int>(residuals.rows()));
}

}  // namespace

void DifferenceNoise::add(double time, const Eigen::VectorXd& value) {
  ++added_;
  if (!value.allFinite() || (!times_.empty() && !(time > times_.back()))) return;
  times_.push_back(time);
  values_.push_back(value);
  numbers_.push_back(added_ - 1);
}

// Returns r_k of every value but the first and the last, one column each.
Eigen::MatrixXd DifferenceNoise::residuals() const {
  if (values_.size() < 3) return {};
  Eigen::MatrixXd out(values_.front().size(), static_cast<Eigen::Index>(values_.size()) - 2);
  for (std::size_t k = 1; k + 1 < values_.size(); ++k) {
    const double a = (times_[k + 1] - times_[k]) / (times_[k + 1] - times_[k - 1]), b = 1.0 - a;
    out.col(static_cast<Eigen::Index>(k) - 1) =
        (a * values_[k - 1] + b * values_[k + 1] - values_[k]) / std::sqrt(a * a + b * b + 1.0);
  }
  return out;
}

double DifferenceNoise::variance() const {
  const Eigen::MatrixXd r = residuals();
  if (r.size() == 0) return std::numeric_limits<double>::infinity();
  const Eigen::Map<const Eigen::VectorXd> rows(r.data(), r.size());
  return rows.cwiseAbs2().dot(weights_of(r)) / static_cast<double>(r.size());
}

Eigen::VectorXd DifferenceNoise::weights() const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(added_);
  const Eigen::MatrixXd r = residuals();
  if (r.size() == 0) return out;
  const Eigen::VectorXd weights = weights_of(r);
  for (Eigen::Index k = 0; k < r.cols(); ++k) out[numbers_[static_cast<std::size_t>(k) + 1]] = weights[k * r.rows()];
  return out;
}

}  // namespace tissue_stiffness
