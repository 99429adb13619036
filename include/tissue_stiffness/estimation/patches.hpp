#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Tetrahedra of one patch, ascending.
using Patch = std::vector<int>;

/// One division of a body into patches, and where each patch came from.
struct Division {
  std::vector<Patch> patches;
  std::vector<int> parent;  ///< of each patch, in the division that was split
};

/// Splits the largest patches (by volume) until there are `count` of them, or one tetrahedron each: in two halves of equal
/// volume across the direction in which the patch is longest, as recursive inertial bisection does (Simon 1991), but along
/// a coordinate axis where the patch is almost as long. Deterministic; each patch of the result lies within its parent.
Division split(const TetMesh& mesh, const std::vector<Patch>& patches, int count);

/// Centres of volume, 3 x patches [m].
Eigen::Matrix3Xd centers(const TetMesh& mesh, const std::vector<Patch>& patches);

/// Covariance of a Gaussian process at places x_i, of standard deviation `std`, that is smooth over `length` [m]: Matern of
/// order 3/2 (Rasmussen & Williams 2006, eq. 4.17),
///   std^2 (1 + r) exp(-r), r = sqrt(3) |x_i - x_j| / length.
/// Positive definite for distinct places.
Eigen::MatrixXd smooth_covariance(const Eigen::Matrix3Xd& places, double length, double std);

}  // namespace tissue_stiffness
