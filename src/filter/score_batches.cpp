#include "filter/score_batches.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostBatches = 32;
constexpr std::size_t kFewestBatches = 16;
constexpr double kBeyondChance = 1.2;  // times the largest eigenvalue that white noise would show
constexpr double kFully = 1.5;         // times that, from which on a direction gets its full apparent width

}  // namespace

void ScoreBatches::add(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient) {
  if (open_.frames == 0) {
    open_ = {information, gradient, 1};
  } else {
    open_.information += information;
    open_.gradient += gradient;
    ++open_.frames;
  }
  if (open_.frames < length_) return;
  batches_.push_back(open_);
  open_.frames = 0;
  if (batches_.size() < kMostBatches) return;
  for (std::size_t k = 0; 2 * k < batches_.size(); ++k) {
    batches_[k] = {batches_[2 * k].information + batches_[2 * k + 1].information,
                   batches_[2 * k].gradient + batches_[2 * k + 1].gradient, 2 * length_};
  }
  batches_.resize(batches_.size() / 2);
  length_ *= 2;
}

Eigen::MatrixXd ScoreBatches::variance(const Eigen::VectorXd& step) const {
  const Eigen::Index p = step.size();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(p, p);
  if (batches_.size() < kFewestBatches) return sum;
  for (const Batch& batch : batches_) {
    const Eigen::VectorXd score = batch.gradient - batch.information * step;
    sum += score * score.transpose();
  }
  const double n = static_cast<double>(batches_.size());
  return n / (n - 1.0) * sum;
}

Eigen::MatrixXd ScoreBatches::widened(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& variance) const {
  if (batches_.size() < kFewestBatches) return covariance;
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return covariance;
  const Eigen::MatrixXd l = root.matrixL();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(l.transpose() * variance * l);
  const double chance =
      kBeyondChance *
      std::pow(1.0 + std::sqrt(static_cast<double>(covariance.rows()) / static_cast<double>(batches_.size())), 2);
  const Eigen::VectorXd factor = eigen.eigenvalues().unaryExpr([&](double f) {
    const double share = std::clamp((f - chance) / ((kFully - 1.0) * chance), 0.0, 1.0);
    return 1.0 + share * (std::max(f, 1.0) - 1.0);
  });
  const Eigen::MatrixXd wide = l * eigen.eigenvectors() * factor.cwiseSqrt().asDiagonal();
  return wide * wide.transpose();
}

}  // namespace tissue_stiffness
