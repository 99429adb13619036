#include "filter/noise.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

Noise Noise::independent(Eigen::VectorXd sigma) {
  if (!(sigma.array() > 0.0).all()) throw std::invalid_argument("standard deviations of noise must be > 0");
  Noise noise;
  noise.sigma_ = std::move(sigma);
  return noise;
}

Noise Noise::correlated(const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (cholesky.info() != Eigen::Success)
    throw NumericalError("the measurement noise's covariance is not positive definite");
  Noise noise;
  noise.diagonal_ = false;
  noise.factor_ = cholesky.matrixL();
  return noise;
}

bool Noise::usable(Eigen::Index row) const {
  return !diagonal_ || std::isfinite(sigma_[row]);
}

Eigen::MatrixXd Noise::whiten(const Eigen::MatrixXd& columns) const {
  if (diagonal_) return sigma_.cwiseInverse().asDiagonal() * columns;
  return factor_.triangularView<Eigen::Lower>().solve(columns);
}

double Noise::log_determinant() const {
  return diagonal_ ? 2.0 * sigma_.array().log().sum() : 2.0 * factor_.diagonal().array().log().sum();
}

Eigen::VectorXd Noise::variance() const {
  if (diagonal_) return sigma_.cwiseAbs2();
  return factor_.rowwise().squaredNorm();
}

Noise Noise::rows(const std::vector<Eigen::Index>& indices) const {
  if (static_cast<Eigen::Index>(indices.size()) == size()) return *this;
  const auto count = static_cast<Eigen::Index>(indices.size());
  if (!diagonal_) {
    const Eigen::MatrixXd full = factor_ * factor_.transpose();
    Eigen::MatrixXd part(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < count; ++j) {
        part(i, j) = full(indices[static_cast<std::size_t>(i)], indices[static_cast<std::size_t>(j)]);
      }
    }
    return correlated(part);
  }
  Eigen::VectorXd sigma(count);
  for (Eigen::Index i = 0; i < count; ++i) sigma[i] = sigma_[indices[static_cast<std::size_t>(i)]];
  return independent(std::move(sigma));
}

}  // namespace tissue_stiffness
