#include "tissue_stiffness/segmentation/edge_fit.hpp"

#include <Eigen/QR>
#include <cmath>

#include "tissue_stiffness/segmentation/outline.hpp"

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
  const Eigen::Index n = times_.size();
  const int count = static_cast<int>(std::lround(search / grid));
  for (int k = -count; k <= count; ++k) {
    Candidate candidate;
    candidate.offset = grid * k;
    Eigen::MatrixXd design(n, 4);
    Eigen::VectorXd slope(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double distance = times_(i) - candidate.offset;
      const double inside = normal_distribution(-distance / blur);
      design.row(i) << inside, distance * inside, 1.0 - inside, distance * (1.0 - inside);
      slope(i) = inverse_sqrt_2pi / blur * std::exp(-0.5 * distance * distance / (blur * blur));
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design);
    candidate.basis = qr.householderQ() * Eigen::MatrixXd::Identity(n, 4);
    const Eigen::MatrixXd solve = qr.solve(Eigen::MatrixXd::Identity(n, n));
    candidate.step = solve.row(0) - solve.row(2);
    candidate.derivative = slope - candidate.basis * (candidate.basis.transpose() * slope);
    candidates_.push_back(std::move(candidate));
  }
}

EdgeFit StepEdge::fit(const Eigen::VectorXd& profile) const {
  const Eigen::VectorXd centred = profile.array() - profile.mean();
  const double total = centred.squaredNorm();
  Eigen::VectorXd residual(static_cast<Eigen::Index>(candidates_.size()));
  for (Eigen::Index k = 0; k < residual.size(); ++k) {
    const Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
    // A falling step only: another sign is another thing's edge.
    const bool falls = candidate.step.dot(centred) > 0.0;
    residual(k) = falls ? total - (candidate.basis.transpose() * centred).squaredNorm() : total;
  }
  Eigen::Index best = 0;
  EdgeFit result;
  result.residual = residual.minCoeff(&best);
  const Candidate& candidate = candidates_[static_cast<std::size_t>(best)];
  result.offset = candidate.offset;
  result.step = candidate.step.dot(centred);
  result.gain = result.step * result.step * candidate.derivative.squaredNorm();
  result.at_end = best == 0 || best + 1 == residual.size() || result.step <= 0.0;
  if (result.at_end) return result;
  const double before = residual(best - 1), after = residual(best + 1);
  const double bend = before - 2.0 * result.residual + after;
  if (bend > 0.0) result.offset += 0.5 * grid * (before - after) / bend;
  return result;
}

Eigen::VectorXd normal_profile(const cv::Mat& grey, const Eigen::Vector2d& point, const Eigen::Vector2d& normal,
                               int reach) {
  const Eigen::Vector2d tangent(-normal.y(), normal.x());
  Eigen::VectorXd profile = Eigen::VectorXd::Zero(2 * reach + 1);
  for (int line = -1; line <= 1; ++line) {
    for (int t = -reach; t <= reach; ++t) {
      const Eigen::Vector2d place = point + t * normal + line * tangent;
      profile(t + reach) += sample(grey, place.x(), place.y()) / 3.0;
    }
  }
  return profile;
}

}  // namespace tissue_stiffness
