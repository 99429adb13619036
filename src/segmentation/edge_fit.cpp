#include "segmentation/edge_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "segmentation/outline.hpp"

namespace tissue_stiffness {
namespace {

constexpr double grid = 0.25;  // [pixel] between the tried offsets
constexpr double inverse_sqrt_2pi = 0.3989422804014327;

double normal_distribution(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

}  // namespace

StepEdge::StepEdge(double blur, int reach, double search)
    : blur_(blur), times_(Eigen::VectorXd::LinSpaced(2 * reach + 1, -reach, reach)) {
  const Eigen::Index n = times_.size(), half = std::lround(search / grid), count = 2 * half + 1;
  offsets_ = Eigen::VectorXd::LinSpaced(count, -grid * static_cast<double>(half), grid * static_cast<double>(half));
  bases_.resize(4 * count, n);
  steps_.resize(count, n);
  gains_.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::MatrixXd design(n, 4);
    Eigen::VectorXd slope(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double distance = times_(i) - offsets_(k);
      const double inside = normal_distribution(-distance / blur);
      design.row(i) << inside, distance * inside, 1.0 - inside, distance * (1.0 - inside);
      slope(i) = inverse_sqrt_2pi / blur * std::exp(-0.5 * distance * distance / (blur * blur));
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design);
    const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(n, 4);
    const Eigen::MatrixXd solve = qr.solve(Eigen::MatrixXd::Identity(n, n));
    bases_.middleRows(4 * k, 4) = basis.transpose();
    steps_.row(k) = solve.row(0) - solve.row(2);
    gains_(k) = (slope - basis * (basis.transpose() * slope)).squaredNorm();
  }
}

std::vector<EdgeFit> StepEdge::fit(const Eigen::MatrixXd& profiles) const {
  const Eigen::MatrixXd centred = profiles.rowwise() - profiles.colwise().mean();
  const Eigen::MatrixXd coefficients = bases_ * centred, steps = steps_ * centred;
  const Eigen::Index count = offsets_.size();
  std::vector<EdgeFit> fits(static_cast<std::size_t>(profiles.cols()));
  Eigen::VectorXd residual(count);
  for (Eigen::Index i = 0; i < profiles.cols(); ++i) {
    // A falling step only: another sign is another thing's edge.
    for (Eigen::Index k = 0; k < count; ++k) {
      residual(k) = steps(k, i) > 0.0 ? -coefficients.col(i).segment<4>(4 * k).squaredNorm() : 0.0;
    }
    residual.array() += centred.col(i).squaredNorm();
    Eigen::Index best = 0;
    EdgeFit& fit = fits[static_cast<std::size_t>(i)];
    fit.residual = std::max(0.0, residual.minCoeff(&best));
    fit.offset = offsets_(best);
    fit.step = steps(best, i);
    fit.gain = fit.step * fit.step * gains_(best);
    fit.at_end = best == 0 || best + 1 == count || fit.step <= 0.0;
    if (fit.at_end) continue;
    const double before = residual(best - 1), after = residual(best + 1);
    const double bend = before - 2.0 * residual(best) + after;
    if (bend > 0.0) fit.offset += 0.5 * grid * (before - after) / bend;
  }
  return fits;
}

Eigen::VectorXd normal_profile(const cv::Mat& grey, const Eigen::Vector2d& point, const Eigen::Vector2d& normal,
                               int reach) {
  const Eigen::Vector2d tangent(-normal.y(), normal.x());
  Eigen::VectorXd profile = Eigen::VectorXd::Zero(2 * reach + 1);
  for (int line = -1; line <= 1; ++line) {
    for (int t = -reach; t <= reach; ++t) {
      const Eigen::Vector2d place = point + t * normal + line * tangent;
      profile(t + reach) += sample_bilinear(grey, place.x(), place.y()) / 3.0;
    }
  }
  return profile;
}

}  // namespace tissue_stiffness
