#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "segmentation/cavity.hpp"
#include "segmentation/edge_fit.hpp"
#include "segmentation/outline.hpp"
#include "types/median.hpp"

namespace tissue_stiffness {
namespace {

constexpr double speckle_decibel = 5.57;    // standard deviation of log-compressed Rayleigh speckle
constexpr double stretch_fraction = 0.045;  // of the outline, over which levels and mean profiles are averaged (Gaussian)
constexpr double typical_fraction = 0.5;    // of the median contrast that a wall must have; leaflets have less
constexpr double smallest_contrast = 0.2;   // (wall - pool) / (wall + pool)
constexpr double step_uncertainty =
    0.25;  // of the step from half grey to half power, because the compression is not known exactly
constexpr double contrast_floor = 2.0;    // [grey] on top of it
constexpr double farthest_offset = 0.15;  // of the radius, from the path
constexpr double smallest_scatter = 0.3;  // [pixel]
constexpr double largest_scatter = 0.04;  // of the radius
constexpr Eigen::Index neighbours = 6;    // on each side
constexpr double shortest_run = 0.04;     // of the outline
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns where a column rises through `level`, at the crossing nearest to row `start`; it is negative when there is none.
double crossing(const Eigen::VectorXd& column, double level, Eigen::Index start) {
  double best = -1.0;
  for (Eigen::Index r = 0; r + 1 < column.size(); ++r) {
    if (column(r) > level || column(r + 1) <= level) continue;
    const double place = static_cast<double>(r) + (level - column(r)) / (column(r + 1) - column(r));
    if (best < 0.0 || std::abs(place - static_cast<double>(start)) < std::abs(best - static_cast<double>(start)))
      best = place;
  }
  return best;
}

/// Returns the profiles along all normals: one column for each normal, rows from -reach to reach.
Eigen::MatrixXd profiles_of(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, const Eigen::Matrix2Xd& normals,
                            const Eigen::VectorXd& shift, int reach) {
  Eigen::MatrixXd profiles(2 * reach + 1, outline.cols());
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    profiles.col(i) = normal_profile(grey, outline.col(i) + shift(i) * normals.col(i), normals.col(i), reach);
  }
  return profiles;
}

/// Grey levels on both sides of the outline, averaged over a stretch of it.
struct Surroundings {
  double stretch;            ///< [points] averaging length along the outline
  int reach, near, far;      ///< [pixel] half length of profiles; range in which the wall is evaluated
  Eigen::MatrixXd profiles;  ///< grey, one normal a column, rows from -reach to reach
  Eigen::RowVectorXd pool, wall;
  Eigen::Array<bool, 1, Eigen::Dynamic> thick;  ///< bright everywhere from near to far: no leaflet, no drop-out
};

Surroundings measure_surroundings(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, const Eigen::Matrix2Xd& normals,
                                  double radius) {
  Surroundings s;
  s.stretch = stretch_fraction * static_cast<double>(outline.cols());
  s.reach = std::max(8, static_cast<int>(0.3 * radius));
  s.near = std::max(2, static_cast<int>(0.08 * radius));
  s.far = std::max(s.near + 3, static_cast<int>(0.25 * radius));
  s.profiles = profiles_of(grey, outline, normals, Eigen::VectorXd::Zero(outline.cols()), s.reach);
  const Eigen::MatrixXd levels = smooth_closed(s.profiles, s.stretch);
  const Eigen::MatrixXd local = smooth_closed(s.profiles, 0.2 * s.stretch);
  s.wall = levels.middleRows(s.reach + s.near, s.far - s.near).colwise().mean();
  s.pool = levels.topRows(s.reach - s.near).colwise().mean();
  const Eigen::RowVectorXd half = 0.5 * (s.wall + s.pool);
  const int part = std::max(1, (s.far - s.near) / 3);
  const auto mean_from = [&](int start) { return local.middleRows(s.reach + start, part).colwise().mean().array(); };
  s.thick = (s.wall - s.pool).array() > smallest_contrast * (s.wall + s.pool).array() + contrast_floor;
  std::vector<double> contrasts;
  for (Eigen::Index i = 0; i < s.wall.size(); ++i) {
    if (s.thick(i)) contrasts.push_back(s.wall(i) - s.pool(i));
  }
  s.thick = s.thick && (s.wall - s.pool).array() > typical_fraction * median_of(contrasts);
  for (int start = s.near; start + part <= s.far; start += part) s.thick = s.thick && mean_from(start) > half.array();
  return s;
}

/// Returns the grey levels per decibel, from the scatter of a thick wall's pixels about the wall's level.
double grey_per_decibel(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, const Eigen::Matrix2Xd& normals,
                        const Surroundings& s) {
  double sum = 0.0;
  int count = 0;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    for (int t = s.near; t < s.far && s.thick(i); ++t) {
      const Eigen::Vector2d p = outline.col(i) + t * normals.col(i);
      if (!inside_image(p, grey, 1.0)) continue;
      const double d = grey.at<float>(cvRound(p.y()), cvRound(p.x())) - s.wall(i);
      sum += d * d;
      ++count;
    }
  }
  return std::max(std::sqrt(sum / std::max(count, 1)) / speckle_decibel, 0.1);
}

/// Finds the midpoint in grey between pool and wall, where the wall is thick and the point is near the path. Points that
/// disagree with their neighbours are dropped.
WallEdges half_grey(const Surroundings& s, double radius) {
  const Eigen::Index n = s.profiles.cols();
  WallEdges edges{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, infinity)};
  const Eigen::MatrixXd fine = smooth_closed(s.profiles, 1.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!s.thick(i)) continue;
    const double place = crossing(fine.col(i), 0.5 * (s.wall(i) + s.pool(i)), s.reach) - s.reach;
    if (place < -s.reach || std::abs(place) > farthest_offset * radius) continue;
    edges.offsets(i) = place;
    edges.sigma(i) = 0.0;
  }
  const WallEdges found = edges;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!std::isfinite(found.sigma(i))) continue;
    std::vector<double> around, distances;
    for (Eigen::Index k = n - neighbours; k <= n + neighbours; ++k) {
      if (std::isfinite(found.sigma((i + k) % n))) around.push_back(found.offsets((i + k) % n));
    }
    const double middle = median_of(around);
    for (const double offset : around) distances.push_back(std::abs(offset - middle));
    const double scatter = std::max(smallest_scatter, 1.4826 * median_of(distances));
    const bool stands_out = std::abs(found.offsets(i) - middle) > 3.0 * scatter || scatter > largest_scatter * radius;
    edges.sigma(i) = stands_out || 2 * around.size() < neighbours ? infinity : scatter;
  }
  drop_short_runs(static_cast<int>(shortest_run * static_cast<double>(n)), &edges.sigma);
  return edges;
}

/// Averages the offsets along the outline over a stretch, using only the known ones.
Eigen::VectorXd smooth_known(const WallEdges& edges, double stretch) {
  Eigen::MatrixXd rows(2, edges.offsets.size());
  rows.row(1) = edges.sigma.array().isFinite().cast<double>().transpose();
  rows.row(0) = edges.offsets.transpose().cwiseProduct(rows.row(1));
  rows = smooth_closed(rows, stretch);
  return (rows.row(0).array() / rows.row(1).array().max(1e-9)).transpose();
}

/// Returns the distance outwards from half grey to half power, for one profile that is averaged over a stretch. The wall is
/// the brightest `width` pixels, because the interface may echo more than the wall behind it. The pool mixes with the
/// interface.
double advance_to_half_power(const Eigen::VectorXd& profile, double pool, double decibel, int width) {
  double wall = pool;
  for (Eigen::Index r = 0; r + width <= profile.size(); ++r) wall = std::max(wall, profile.segment(r, width).mean());
  const double ratio = std::pow(10.0, (pool - wall) / (10.0 * decibel));
  const double level = wall + 10.0 * decibel * std::log10(0.5 * (1.0 + ratio));
  for (Eigen::Index r = 0; r + 1 < profile.size(); ++r) {
    if (profile(r) > level) return static_cast<double>(r);
    if (profile(r + 1) > level) return static_cast<double>(r) + (level - profile(r)) / (profile(r + 1) - profile(r));
  }
  return 0.0;
}

}  // namespace

WallEdges wall_edges(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, const Eigen::Matrix2Xd& normals, double radius) {
  const Surroundings s = measure_surroundings(grey, outline, normals, radius);
  WallEdges edges = half_grey(s, radius);
  const double decibel = grey_per_decibel(grey, outline, normals, s);
  const Eigen::VectorXd course = smooth_known(edges, s.stretch);
  const Eigen::MatrixXd aligned = smooth_closed(profiles_of(grey, outline, normals, course, s.reach), s.stretch);
  for (Eigen::Index i = 0; i < edges.sigma.size(); ++i) {
    if (!std::isfinite(edges.sigma(i))) continue;
    const Eigen::VectorXd outward = aligned.col(i).segment(s.reach, 2 * s.near + 1);
    const double advance = advance_to_half_power(outward, s.pool(i), decibel, std::max(1, s.near / 2));
    edges.offsets(i) += advance;
    edges.sigma(i) = std::hypot(edges.sigma(i), step_uncertainty * advance);
  }
  return edges;
}

}  // namespace tissue_stiffness
