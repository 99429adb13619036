#include "estimation/misfit_test.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr double kMostAutocorrelation = 0.95;

}  // namespace

Eigen::MatrixXd with_unit_columns(const Eigen::MatrixXd& shapes, const std::vector<Eigen::Index>& rows) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(shapes.rows(), shapes.cols() + static_cast<Eigen::Index>(rows.size()));
  out.leftCols(shapes.cols()) = shapes;
  for (std::size_t k = 0; k < rows.size(); ++k) out(rows[k], shapes.cols() + static_cast<Eigen::Index>(k)) = 1.0;
  return out;
}

void MisfitTest::add(const Eigen::VectorXd& residual, const Eigen::VectorXd& precision, const Eigen::MatrixXd& shapes) {
  const Eigen::VectorXd root = precision.cwiseSqrt();
  const Eigen::VectorXd r = root.cwiseProduct(residual);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(root.asDiagonal() * shapes);
  const Eigen::Index rank = qr.rank();
  Eigen::VectorXd rotated = r;
  rotated.applyOnTheLeft(qr.householderQ().setLength(rank).adjoint());
  const double along = rotated.head(rank).squaredNorm();
  rotated.head(rank).setZero();
  rotated.applyOnTheLeft(qr.householderQ().setLength(rank));
  const double used = static_cast<double>((precision.array() > 0.0).count());
  along_ += along;
  along_dof_ += static_cast<double>(rank);
  rest_ += rotated.squaredNorm();
  rest_dof_ += used - static_cast<double>(rank);
  rows_ += used;
  rests_.add(rotated);
  ++frames_;
}

void MisfitTest::add_differences(const Eigen::VectorXd& differences) {
  difference_square_ += differences.squaredNorm();
  difference_count_ += static_cast<double>((differences.array() != 0.0).count());
  differences_.add(differences);
}

void MisfitTest::Successive::add(const Eigen::VectorXd& next) {
  if (last.size() == next.size()) {
    product += last.dot(next);
    square += 0.5 * (last.squaredNorm() + next.squaredNorm());
  }
  last = next;
}

double MisfitTest::noise_level() const {
  if (!(rest_dof_ > 0.0)) return 1.0;
  double level = rest_ / rest_dof_;
  if (difference_count_ > 0.0) level = std::min(level, difference_square_ / difference_count_);
  return std::min(std::clamp(level, 1.0, most_noise), known_noise_);
}

double MisfitTest::excess() const {
  const double dof = std::max(1.0, along_dof_ - fitted_);
  return std::max(0.0, along_ - explained_) / dof - noise_level() - numerics_ * rows_ / std::max(1.0, along_dof_);
}

double MisfitTest::lag1_autocorrelation() const {
  const Successive& known = difference_count_ > 0.0 ? differences_ : rests_;
  return known.square > 0.0 ? std::clamp(known.product / known.square, 0.0, kMostAutocorrelation) : 0.0;
}

double MisfitTest::deviation() const {
  const double dof = std::max(1.0, along_dof_ - fitted_);
  return std::sqrt(2.0 * repeated() * dof * noise_level() * noise_level() + variance_) / dof;
}

double MisfitTest::z() const {
  if (frames_ == 0) return 0.0;
  const double tolerance = std::max(tolerated_ * noise_level(), shared_noise());
  return std::max((excess() - tolerance) / deviation(), z_across());
}

double MisfitTest::shared_noise() const {
  return difference_count_ > 0.0 ? std::max(0.0, 1.0 - difference_square_ / difference_count_) : 0.0;
}

// Only what is far above the known noise counts, because less is known of the mesh's error there.
double MisfitTest::z_across() const {
  const bool known = known_noise_ < most_noise || difference_count_ > 0.0;
  if (!known || !(rest_dof_ > 0.0)) return -std::numeric_limits<double>::infinity();
  return (excess_across() / noise_level() - tolerated) / std::sqrt(2.0 * repeated() / rest_dof_);
}

double MisfitTest::excess_across() const {
  return (rest_ - numerics_across_ * rows_) / rest_dof_ - noise_level();
}

double MisfitTest::repeated() const {
  const double square = lag1_autocorrelation() * lag1_autocorrelation();
  return (1.0 + square) / (1.0 - square);
}

double MisfitTest::discrepancy() const {
  if (frames_ == 0) return 0.0;
  const double along = excess() < beyond_chance * deviation() ? 0.0 : excess() * along_dof_;
  const double across = z_across() <= bound ? 0.0 : excess_across() * rest_dof_;
  return (along + across) / std::max(1.0, rows_);
}

}  // namespace tissue_stiffness
