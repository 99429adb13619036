#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// Returns the area of a closed polygon. It is positive when the polygon runs counter-clockwise.
double polygon_area(const Eigen::Matrix2Xd& outline);

/// Returns the first two sides (i, j) of a closed polygon that cross or touch without being neighbours, if there are any.
std::optional<std::pair<int, int>> find_crossing(const Eigen::Matrix2Xd& outline);

/// Returns triangles that fill a simple polygon. Ears are cut (Meisters 1975), the best-shaped first. `loops` are columns
/// of `points`: the outline counter-clockwise, holes clockwise, in any order. Holes are first joined by bridges.
std::vector<Eigen::Vector3i> cut_ears(const Eigen::Matrix2Xd& points, const std::vector<std::vector<int>>& loops);

}  // namespace tissue_stiffness
