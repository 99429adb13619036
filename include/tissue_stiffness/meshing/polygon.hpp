#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// A plane with right-handed coordinates in it, so that a counter-clockwise outline seen against the normal stays one.
class PlaneFrame {
 public:
  PlaneFrame(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal)
      : origin_(origin), u_(normal.unitOrthogonal()), v_(normal.normalized().cross(u_)) {}

  Eigen::Vector2d flatten(const Eigen::Vector3d& x) const { return {u_.dot(x - origin_), v_.dot(x - origin_)}; }
  Eigen::Vector3d lift(const Eigen::Vector2d& p) const { return origin_ + p.x() * u_ + p.y() * v_; }

 private:
  Eigen::Vector3d origin_, u_, v_;
};

/// Area of a closed polygon, positive when it runs counter-clockwise.
double polygon_area(const Eigen::Matrix2Xd& outline);

/// A point strictly inside a simple polygon of at least three points.
Eigen::Vector2d inner_point(const Eigen::Matrix2Xd& outline);

/// The first two sides (i, j) of a closed polygon that cross or touch without being neighbours.
std::optional<std::pair<int, int>> find_crossing(const Eigen::Matrix2Xd& outline);

/// Triangles that fill a simple counter-clockwise polygon, by cutting ears (Meisters 1975): columns - 2 of them.
std::vector<Eigen::Vector3i> cut_ears(const Eigen::Matrix2Xd& outline);

}  // namespace tissue_stiffness
