#include "tissue_stiffness/meshing/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tissue_stiffness {
namespace {

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

}  // namespace

double polygon_area(const Eigen::Matrix2Xd& outline) {
  double doubled = 0.0;
  const Eigen::Index n = outline.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    doubled += cross(outline.col(i) - outline.col(0), outline.col((i + 1) % n) - outline.col(0));
  }
  return 0.5 * doubled;
}

// O'Rourke, Computational Geometry in C, section 1.6: at a strictly convex vertex v with neighbours a and b, either the
// triangle a v b is empty, or the vertex in it that is farthest from ab sees v.
Eigen::Vector2d inner_point(const Eigen::Matrix2Xd& outline) {
  const Eigen::Index n = outline.cols();
  Eigen::Index v = 0;
  for (Eigen::Index i = 1; i < n; ++i) {
    if (outline(0, i) < outline(0, v) || (outline(0, i) == outline(0, v) && outline(1, i) < outline(1, v))) v = i;
  }
  const Eigen::Vector2d a = outline.col((v + n - 1) % n), b = outline.col((v + 1) % n), tip = outline.col(v);
  const double turn = side_of(a, tip, b) > 0.0 ? 1.0 : -1.0;
  double farthest = 0.0;
  Eigen::Index inside = -1;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d p = outline.col(i);
    if (p == a || p == b || p == tip) continue;
    const double height = turn * side_of(b, a, p);  // above ab, on the tip's side
    const bool in_triangle = turn * side_of(a, tip, p) >= 0.0 && turn * side_of(tip, b, p) >= 0.0 && height >= 0.0;
    if (in_triangle && (inside < 0 || height > farthest)) {
      farthest = height;
      inside = i;
    }
  }
  return inside < 0 ? Eigen::Vector2d((a + b + tip) / 3.0) : Eigen::Vector2d(0.5 * (tip + outline.col(inside)));
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

std::vector<Eigen::Vector3i> cut_ears(const Eigen::Matrix2Xd& outline) {
  std::vector<int> left(static_cast<std::size_t>(outline.cols()));
  std::iota(left.begin(), left.end(), 0);
  std::vector<Eigen::Vector3i> triangles;
  const auto ear_shape = [&](int a, int b, int c) {
    const Eigen::Vector2d pa = outline.col(a), pb = outline.col(b), pc = outline.col(c);
    const bool empty = std::none_of(left.begin(), left.end(), [&](int i) {
      const Eigen::Vector2d p = outline.col(i);
      return i != a && i != b && i != c && side_of(pa, pb, p) >= 0.0 && side_of(pb, pc, p) >= 0.0 &&
             side_of(pc, pa, p) >= 0.0;
    });
    const double sides = (pb - pa).squaredNorm() + (pc - pb).squaredNorm() + (pa - pc).squaredNorm();
    return empty ? side_of(pa, pb, pc) / sides : -std::numeric_limits<double>::infinity();
  };
  while (left.size() > 3) {  // the best-shaped ear first, so that points along a straight side do not stay for the end
    const std::size_t n = left.size();
    std::size_t best = 0;
    double best_shape = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double shape = ear_shape(left[(i + n - 1) % n], left[i], left[(i + 1) % n]);
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
