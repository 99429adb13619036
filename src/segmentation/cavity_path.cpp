#include <algorithm>
#include <cmath>
#include <limits>

#include "segmentation/cavity.hpp"
#include "segmentation/outline.hpp"

namespace tissue_stiffness {
namespace {

constexpr int rays = 128;
constexpr double thick = 0.3, thin = 0.2;  // of the pool's radius: averaging lengths outside and inside the edge
constexpr double farthest = 2.4;           // of the pool's radius
constexpr double stiffness = 0.03;
constexpr double floor_grey = 8.0;

/// Sums grey along each ray from the centre. Row r holds the sum of samples 0 ... r-1, which are one pixel apart.
Eigen::MatrixXd ray_sums(const cv::Mat& grey, const Eigen::Vector2d& centre, int length) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(length + 1, rays);
  for (int k = 0; k < rays; ++k) {
    const double angle = 2.0 * M_PI * k / rays;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    for (int r = 0; r < length; ++r) {
      const Eigen::Vector2d p = centre + r * direction;
      sums(r + 1, k) = sums(r, k) + (inside_image(p, grey, 0.0) ? sample_bilinear(grey, p.x(), p.y()) : 0.0);
    }
  }
  return sums;
}

/// Returns the smoothed distance from the centre to a closed curve along each ray; it is that of the farthest point near
/// the ray.
Eigen::VectorXd radii_of(const Eigen::Matrix2Xd& outline, const Eigen::Vector2d& centre) {
  Eigen::RowVectorXd radii = Eigen::RowVectorXd::Zero(rays);
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    const Eigen::Vector2d d = outline.col(i) - centre;
    const double turn = std::atan2(d.y(), d.x()) / (2.0 * M_PI) * rays;
    const int k = (static_cast<int>(std::lround(turn)) + rays) % rays;
    radii(k) = std::max(radii(k), d.norm());
  }
  for (int k = 1; k < 2 * rays; ++k) {
    if (radii(k % rays) == 0.0) radii(k % rays) = radii((k - 1) % rays);
  }
  return smooth_keeping_bends(radii, 3.0).transpose();
}

}  // namespace

WallPath trace_wall(const cv::Mat& grey, const Pool& pool, const Eigen::Matrix2Xd& near_path, double reach) {
  const int outside = std::max(3, static_cast<int>(std::lround(thick * pool.radius)));
  const int inside = std::max(2, static_cast<int>(std::lround(thin * pool.radius)));
  const int first = std::max(inside + 1, static_cast<int>(0.3 * pool.radius));
  const int last = std::max(first + 8, static_cast<int>(farthest * pool.radius));
  const Eigen::MatrixXd sums = ray_sums(grey, pool.centre, last + outside + 1);
  const bool free = near_path.cols() == 0;
  const int half = free ? (last - first) / 2 : std::max(4, static_cast<int>(reach * pool.radius));
  const Eigen::VectorXd middle = free ? Eigen::VectorXd::Constant(rays, first + half) : radii_of(near_path, pool.centre);

  const Eigen::Index count = last - first;
  const Eigen::MatrixXd walls = (sums.middleRows(first + outside, count) - sums.middleRows(first, count)) / outside;
  Eigen::MatrixXd crossed(count, rays);  // the brightest stretch before: thin leaflets may be crossed, walls may not
  Eigen::RowVectorXd running = Eigen::RowVectorXd::Zero(rays);
  for (int r = inside; r < last; ++r) {
    running = running.cwiseMax((sums.row(r) - sums.row(r - inside)) / inside);
    if (r >= first) crossed.row(r - first) = running;
  }
  const Eigen::RowVectorXd brightest = walls.colwise().maxCoeff();
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(2 * half + 1, rays, 1.0);
  for (int k = 0; k < rays; ++k) {
    for (int row = 0; row <= 2 * half; ++row) {
      const int r = static_cast<int>(std::lround(middle(k))) + row - half;
      if (r < first || r >= last) continue;
      cost(row, k) = -std::max(0.0, (walls(r - first, k) - crossed(r - first, k)) / (brightest(k) + floor_grey));
    }
  }
  const Eigen::VectorXi path = closed_minimum_path(cost, stiffness, 2);
  WallPath result{Eigen::Matrix2Xd(2, rays), 0.0};
  for (int k = 0; k < rays; ++k) {
    const double angle = 2.0 * M_PI * k / rays, radius = std::round(middle(k)) + path(k) - half - 0.5;
    result.points.col(k) = pool.centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    result.score -= cost(path(k), k) / rays;
  }
  return result;
}

}  // namespace tissue_stiffness
