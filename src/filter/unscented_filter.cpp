#include "filter/unscented_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "filter/usable_rows.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (!covariance.allFinite() || cholesky.info() != Eigen::Success) {
    throw NumericalError("the parameters' covariance is not positive definite");
  }
  return cholesky.matrixL();
}

}  // namespace

UnscentedFilter::UnscentedFilter(Eigen::VectorXd mean, Eigen::MatrixXd covariance, const UnscentedTuning& tuning)
    : mean_(std::move(mean)),
      covariance_(std::move(covariance)),
      set_(SigmaSet::scaled(static_cast<int>(mean_.size()), tuning)) {
  if (covariance_.rows() != mean_.size() || covariance_.cols() != mean_.size()) {
    throw std::invalid_argument("mean and covariance do not fit together");
  }
  cholesky_factor(covariance_);
}

Eigen::MatrixXd UnscentedFilter::sigma_points() const {
  return set_.points(mean_, cholesky_factor(covariance_));
}

FilterUpdate UnscentedFilter::update(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs,
                                     const Noise& noise) {
  const Eigen::VectorXd& w = set_.covariance_weights();
  const UsableRows rows = usable_rows(measurement, outputs, noise, w.size());
  const Eigen::VectorXd predicted = rows.outputs * set_.mean_weights();   // eq. 18
  const Eigen::MatrixXd deviations = rows.outputs.colwise() - predicted;  // of eq. 19, 20
  const Eigen::MatrixXd parameters = sigma_points().colwise() - mean_;
  const Eigen::VectorXd innovation = rows.measurement - predicted;
  const Eigen::VectorXd variance = deviations.cwiseAbs2() * w + rows.noise.variance();
  FilterUpdate update;
  rows.report(innovation, variance, measurement.size(), update);
  if (update.dof == 0) return update;

  // With Z = R^-1/2 deviations and W = diag(w), P_d = R^1/2 (I + Z W Z^T) R^1/2 (eq. 19). So K = parameters W (I + Z^T Z
  // W)^-1 Z^T R^-1/2 (eq. 20, 21), which is a system of 2L + 1 rows instead of m.
  const Eigen::MatrixXd whitened = rows.noise.whiten(deviations);
  const Eigen::VectorXd whitened_innovation = rows.noise.whiten(innovation);
  const Eigen::MatrixXd gram = whitened.transpose() * whitened;
  const Eigen::Index points = w.size();
  const Eigen::PartialPivLU<Eigen::MatrixXd> system(Eigen::MatrixXd::Identity(points, points) + gram * w.asDiagonal());
  const Eigen::VectorXd projected = whitened.transpose() * whitened_innovation;
  const Eigen::VectorXd solved = system.solve(projected);
  const Eigen::MatrixXd weighted = parameters * w.asDiagonal();
  const Eigen::MatrixXd reduction = weighted * system.solve(gram) * weighted.transpose();  // K P_d K^T
  const Eigen::MatrixXd posterior = covariance_ - 0.5 * (reduction + reduction.transpose());
  cholesky_factor(posterior);
  mean_ += weighted * solved;  // eq. 22
  covariance_ = posterior;     // eq. 23
  update.nis = whitened_innovation.squaredNorm() - projected.dot(w.cwiseProduct(solved));
  const double log_determinant = std::log(std::abs(system.determinant())) + rows.noise.log_determinant();
  update.log_likelihood = log_density(update.nis, log_determinant, update.dof);
  return update;
}

}  // namespace tissue_stiffness
