#include "meshing/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tissue_stiffness {
namespace {

// Share of the squared sides. A corner so near to a side counts as on it, because its coordinates are rounded.
constexpr double kOnSide = 1e-9;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double side_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return cross(b - a, p - a);
}

bool in_box(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const double c_side = side_of(a, b, c), d_side = side_of(a, b, d), a_side = side_of(c, d, a), b_side = side_of(c, d, b);
  if (((c_side > 0.0) != (d_side > 0.0)) && ((a_side > 0.0) != (b_side > 0.0)) && c_side != 0.0 && d_side != 0.0 &&
      a_side != 0.0 && b_side != 0.0) {
    return true;
  }
  return (c_side == 0.0 && in_box(a, b, c)) || (d_side == 0.0 && in_box(a, b, d)) || (a_side == 0.0 && in_box(c, d, a)) ||
         (b_side == 0.0 && in_box(c, d, b));
}

// Returns twice the area over the squared sides of the corner at left[i]. It is minus infinity when other corners lie in
// it.
double ear_shape(const Eigen::Matrix2Xd& points, const std::vector<int>& left, std::size_t i) {
  const std::size_t n = left.size();
  const Eigen::Vector2d a = points.col(left[(i + n - 1) % n]), b = points.col(left[i]), c = points.col(left[(i + 1) % n]);
  const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  const double shape = side_of(a, b, c) / sides;
  if (!(shape > 0.0)) return -std::numeric_limits<double>::infinity();
  for (const int other : left) {
    const Eigen::Vector2d p = points.col(other);
    if (p == a || p == b || p == c) continue;
    if (std::min({side_of(a, b, p), side_of(b, c, p), side_of(c, a, p)}) >= -kOnSide * sides) {
      return -std::numeric_limits<double>::infinity();
    }
  }
  return shape;
}

bool bridge_is_free(const Eigen::Matrix2Xd& points, const std::vector<std::vector<int>>& loops, int from, int to) {
  for (const std::vector<int>& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      if (a == from || b == from || a == to || b == to) continue;
      if (segments_meet(points.col(from), points.col(to), points.col(a), points.col(b))) return false;
    }
  }
  return true;
}

// Joins all loops to one outline. Each hole in turn is joined by the shortest bridge that crosses no side.
std::vector<int> join_loops(const Eigen::Matrix2Xd& points, std::vector<std::vector<int>> loops) {
  const auto area = [&points](const std::vector<int>& loop) {
    Eigen::Matrix2Xd outline(2, static_cast<Eigen::Index>(loop.size()));
    for (std::size_t i = 0; i < loop.size(); ++i) outline.col(static_cast<Eigen::Index>(i)) = points.col(loop[i]);
    return polygon_area(outline);
  };
  std::iter_swap(loops.begin(), std::max_element(loops.begin(), loops.end(),
                                                 [&](const auto& a, const auto& b) { return area(a) < area(b); }));
  while (loops.size() > 1) {
    double shortest = std::numeric_limits<double>::infinity();
    std::size_t loop = 1, at = 0, start = 0;
    for (std::size_t k = 1; k < loops.size(); ++k) {
      for (std::size_t i = 0; i < loops[0].size(); ++i) {
        for (std::size_t j = 0; j < loops[k].size(); ++j) {
          const double length = (points.col(loops[0][i]) - points.col(loops[k][j])).norm();
          if (length >= shortest || !bridge_is_free(points, loops, loops[0][i], loops[k][j])) continue;
          shortest = length;
          loop = k;
          at = i;
          start = j;
        }
      }
    }
    std::vector<int> hole = loops[loop];
    std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(start), hole.end());
    hole.push_back(hole.front());
    hole.push_back(loops[0][at]);
    loops[0].insert(loops[0].begin() + static_cast<std::ptrdiff_t>(at) + 1, hole.begin(), hole.end());
    loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(loop));
  }
  return loops[0];
}

}  // namespace

double polygon_area(const Eigen::Matrix2Xd& outline) {
  double doubled = 0.0;
  const Eigen::Index n = outline.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    doubled += cross(outline.col(i) - outline.col(0), outline.col((i + 1) % n) - outline.col(0));
  }
  return 0.5 * doubled;
}

std::optional<std::pair<int, int>> find_crossing(const Eigen::Matrix2Xd& outline) {
  const auto n = static_cast<int>(outline.cols());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (segments_meet(outline.col(i), outline.col(i + 1), outline.col(j), outline.col((j + 1) % n))) {
        return std::make_pair(i, j);
      }
    }
  }
  return std::nullopt;
}

std::vector<Eigen::Vector3i> cut_ears(const Eigen::Matrix2Xd& points, const std::vector<std::vector<int>>& loops) {
  std::vector<int> left = join_loops(points, loops);
  std::vector<Eigen::Vector3i> triangles;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t best = 0;
    double best_shape = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double shape = ear_shape(points, left, i);
      if (shape > best_shape) {
        best_shape = shape;
        best = i;
      }
    }
    triangles.emplace_back(left[(best + n - 1) % n], left[best], left[(best + 1) % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  triangles.emplace_back(left[0], left[1], left[2]);
  return triangles;
}

}  // namespace tissue_stiffness
