#include "filter/unscented_filter.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "filter/usable_rows.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

/// Returns the square root of a positive semi-definite matrix. Eigenvalues that round-off makes negative count as zero.
Eigen::MatrixXd semidefinite_square_root(const Eigen::MatrixXd& covariance) {
  if (!covariance.allFinite()) throw NumericalError("the state's covariance is not finite");
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::VectorXd& eigenvalues = solver.eigenvalues();
  if (eigenvalues.minCoeff() < -1e-12 * eigenvalues.cwiseAbs().maxCoeff()) {
    throw NumericalError("the state's covariance is indefinite");
  }
  return lower_square_root(solver.eigenvectors() * eigenvalues.cwiseMax(0.0).cwiseSqrt().asDiagonal());
}

}  // namespace

UnscentedFilter::UnscentedFilter(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance, const UnscentedTuning& tuning)
    : UnscentedFilter(mean, covariance, SigmaSet::scaled(static_cast<int>(mean.size()), tuning)) {}

UnscentedFilter::UnscentedFilter(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance, SigmaSet set)
    : mean_(std::move(mean)), set_(std::move(set)) {
  if (covariance.rows() != mean_.size() || covariance.cols() != mean_.size() || set_.unit().rows() != mean_.size()) {
    throw std::invalid_argument("mean, covariance and sigma points do not fit together");
  }
  square_root_ = semidefinite_square_root(covariance);
}

Eigen::MatrixXd UnscentedFilter::sigma_points() const {
  return set_.points(mean_, square_root_);
}

void UnscentedFilter::predict(const SigmaModel& process, const Eigen::MatrixXd& noise_square_root) {
  const Eigen::MatrixXd outputs = process(sigma_points());
  if (outputs.rows() != mean_.size() || noise_square_root.rows() != mean_.size()) {
    throw std::invalid_argument("state, process and process noise do not fit together");
  }
  if (!outputs.allFinite()) throw NumericalError("the process model diverged at a sigma point");
  const UnscentedMoments moments = set_.moments(outputs);
  Eigen::MatrixXd columns(mean_.size(), moments.linear.cols() + moments.remainder.cols() + noise_square_root.cols());
  columns << moments.linear, moments.remainder, noise_square_root;
  mean_ = moments.mean;
  square_root_ = lower_square_root(columns);
}

/// With O = R^-1/2 linear, E = R^-1/2 remainder and z the whitened innovation, the update is the least-squares problem
///   min_{a,b} |z - E b - O a|^2 + |a|^2 + |b|^2,   mean += S a.
/// Its triangular factor, with a's columns last, also holds S's reduction and the NIS (its residual).
FilterUpdate UnscentedFilter::update(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs,
                                     const Noise& noise) {
  const UsableRows rows = usable_rows(measurement, outputs, noise, set_.unit().cols());
  const UnscentedMoments moments = set_.moments(rows.outputs);
  const Eigen::VectorXd innovation = rows.measurement - moments.mean;
  const Eigen::VectorXd variance =
      moments.linear.rowwise().squaredNorm() + moments.remainder.rowwise().squaredNorm() + rows.noise.variance();
  FilterUpdate update;
  rows.report(innovation, variance, measurement.size(), update);
  if (update.dof == 0) return update;

  const Eigen::Index m = update.dof, l = mean_.size(), q = moments.remainder.cols(), n = q + l;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(m + n, n + 1);
  system.block(0, 0, m, q) = rows.noise.whiten(moments.remainder);
  system.block(0, q, m, l) = rows.noise.whiten(moments.linear);
  system.block(0, n, m, 1) = rows.noise.whiten(innovation);
  system.block(m, 0, n, n).setIdentity();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(system);
  const Eigen::MatrixXd factor = qr.matrixQR().topRows(n + 1).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd reduction = factor.block(q, q, l, l);
  const auto triangular = reduction.triangularView<Eigen::Upper>();
  mean_ += square_root_ * triangular.solve(factor.block(q, n, l, 1));
  square_root_ = lower_square_root(triangular.transpose().solve(square_root_.transpose()).transpose());
  update.nis = factor(n, n) * factor(n, n);
  const double log_determinant = 2.0 * factor.diagonal().head(n).array().abs().log().sum() + rows.noise.log_determinant();
  update.log_likelihood = log_density(update.nis, log_determinant, update.dof);
  return update;
}

}  // namespace tissue_stiffness
