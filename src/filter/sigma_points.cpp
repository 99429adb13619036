#include "filter/sigma_points.hpp"

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

namespace tissue_stiffness {
namespace {

void require_dimension(int dimension) {
  if (dimension < 1) throw std::invalid_argument("sigma points need at least one dimension");
}

/// With D_i+- = Y_i+- - Y_0, o_i = (D_i+ - D_i-) / 2 and e_i = (D_i+ + D_i-) / 2, eq. 19's sum is
///   2w (sum o_i o_i^T + sum e_i e_i^T) + (beta - alpha^2) (2w)^2 (sum e_i)(sum e_i)^T,  2w = 1 / gamma^2.
/// This holds although the centre weight of eq. 15 may be negative. The e part is E (I + c 11^T) E^T with c = (beta -
/// alpha^2) 2w. Moreover I + c 11^T = (I + d 11^T)^2 for 1 + d L = sqrt(1 + c L), which is real for beta, kappa >= 0.
UnscentedMoments symmetric_moments(const Eigen::MatrixXd& output, double gamma, const UnscentedTuning& tuning) {
  const Eigen::Index l = (output.cols() - 1) / 2;
  const double size = static_cast<double>(l), pair_weight = 1.0 / (gamma * gamma);
  const auto plus = output.middleCols(1, l), minus = output.rightCols(l);
  UnscentedMoments moments;
  moments.linear = (plus - minus) / (2.0 * gamma);
  Eigen::MatrixXd even = 0.5 * (plus + minus);
  even.colwise() -= output.col(0);
  const Eigen::VectorXd even_sum = even.rowwise().sum();
  moments.mean = output.col(0) + pair_weight * even_sum;
  const double c = (tuning.beta - tuning.alpha * tuning.alpha) * pair_weight;
  const double d = (std::sqrt(std::max(0.0, 1.0 + c * size)) - 1.0) / size;
  moments.remainder = (even.colwise() + d * even_sum) / gamma;
  return moments;
}

}  // namespace

SigmaSet SigmaSet::scaled(int dimension, const UnscentedTuning& tuning) {
  require_dimension(dimension);
  if (!(tuning.alpha > 0.0 && tuning.beta >= 0.0 && tuning.kappa >= 0.0)) {
    throw std::invalid_argument("unscented tuning needs alpha > 0, beta >= 0, kappa >= 0");
  }
  const double alpha2 = tuning.alpha * tuning.alpha;
  const double scale = alpha2 * (dimension + tuning.kappa);  // L + lambda
  const double lambda = scale - dimension;
  SigmaSet set;
  set.tuning_ = tuning;
  set.unit_ = Eigen::MatrixXd::Zero(dimension, 2 * dimension + 1);
  set.unit_.middleCols(1, dimension).diagonal().setConstant(std::sqrt(scale));
  set.unit_.rightCols(dimension).diagonal().setConstant(-std::sqrt(scale));
  set.mean_weights_ = Eigen::VectorXd::Constant(2 * dimension + 1, 0.5 / scale);
  set.mean_weights_[0] = lambda / scale;
  set.covariance_weights_ = set.mean_weights_;
  set.covariance_weights_[0] += 1.0 - alpha2 + tuning.beta;
  return set;
}

SigmaSet SigmaSet::simplex(int dimension) {
  require_dimension(dimension);
  SigmaSet set;
  set.symmetric_ = false;
  set.unit_ = Eigen::MatrixXd::Zero(dimension, dimension + 1);
  for (int row = 0; row < dimension; ++row) {  // Helmert's orthonormal contrasts
    const double norm = std::sqrt((dimension + 1.0) / ((row + 1.0) * (row + 2.0)));
    set.unit_.row(row).head(row + 1).setConstant(norm);
    set.unit_(row, row + 1) = -norm * (row + 1.0);
  }
  set.mean_weights_ = Eigen::VectorXd::Constant(dimension + 1, 1.0 / (dimension + 1.0));
  set.covariance_weights_ = set.mean_weights_;
  return set;
}

Eigen::MatrixXd SigmaSet::points(const Eigen::VectorXd& mean, const Eigen::MatrixXd& square_root) const {
  return (square_root * unit_).colwise() + mean;
}

UnscentedMoments SigmaSet::moments(const Eigen::MatrixXd& output) const {
  if (output.cols() != unit_.cols()) throw std::invalid_argument("one column a sigma point");
  if (symmetric_) return symmetric_moments(output, unit_(0, 1), tuning_);
  UnscentedMoments moments;
  moments.mean = output.rowwise().mean();
  moments.linear = (output.colwise() - moments.mean) * unit_.transpose() / static_cast<double>(unit_.cols());
  moments.remainder.resize(output.rows(), 0);
  return moments;
}

Eigen::MatrixXd lower_square_root(const Eigen::MatrixXd& columns) {
  const Eigen::Index size = columns.rows();
  Eigen::MatrixXd transposed = Eigen::MatrixXd::Zero(std::max(size, columns.cols()), size);
  transposed.topRows(columns.cols()) = columns.transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(transposed);
  Eigen::MatrixXd lower = qr.matrixQR().topRows(size).triangularView<Eigen::Upper>().transpose();
  for (Eigen::Index i = 0; i < size; ++i) {
    if (lower(i, i) < 0.0) lower.col(i) *= -1.0;
  }
  return lower;
}

}  // namespace tissue_stiffness
