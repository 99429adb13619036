#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// Area of a closed polygon, positive when it runs counter-clockwise.
double polygon_area(const Eigen::Matrix2Xd& outline);

/// The first two sides (i, j) of a closed polygon that cross or touch without being neighbours.
std::optional<std::pair<int, int>> find_crossing(const Eigen::Matrix2Xd& outline);

/// Triangles that fill a simple polygon, by cutting ears (Meisters 1975), the best-shaped first. `loops` are columns of
/// `points`: the outline counter-clockwise, holes clockwise, in any order; holes are joined by bridges first.
std::vector<Eigen::Vector3i> cut_ears(const Eigen::Matrix2Xd& points, const std::vector<std::vector<int>>& loops);

}  // namespace tissue_stiffness
