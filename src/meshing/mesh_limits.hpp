#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace tissue_stiffness {

/// A body's longest side lies between these [m]. What is smaller or larger comes of a wrong unit or scale, and its squares
/// and cubes leave the range of the numbers that the mesh is computed with.
constexpr double kSmallestBody = 1e-6, kLargestBody = 1e3;
constexpr double kFarthestPoint = 1e6;        ///< from the origin [m]
constexpr double kMostTetrahedra = 2e6;       ///< that can be worked with: TetGen needs minutes and gigabytes for them
constexpr double kFinestEdge = 1.0 / 1000.0;  ///< of the body's longest side
constexpr std::uintmax_t kLargestMeshFile = 1000000000;  ///< [byte]

/// Throws InputError, naming `where`, for points [m] that are not finite, too far away, or span a body outside these
/// limits.
void check_body_size(const Eigen::Matrix3Xd& points, const std::string& where);

/// Returns about how many tetrahedra of this edge length [m] fill a volume [m^3]: regular ones have edge^3 / (6 sqrt(2)).
double tetrahedra_of(double volume, double edge);

/// Throws InputError for a `max_edge_length` [m] that would divide the body into more than kMostTetrahedra, or its longest
/// side [m] more finely than kFinestEdge. 0 asks for no length.
void check_edge_length(double edge, double longest_side, double volume, const std::string& where);

}  // namespace tissue_stiffness
