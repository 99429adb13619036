#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A patch lists its tetrahedra in ascending order.
using Patch = std::vector<int>;

/// A division holds the patches of a body, and where each came from.
struct Division {
  std::vector<Patch> patches;
  std::vector<int> parent;  ///< of each patch, its index in the division that was split
};

/// Splits the largest patches (by volume) until there are `count` of them, or one tetrahedron each. A patch is cut into two
/// halves of equal volume across its longest direction, as in recursive inertial bisection (Simon 1991). A coordinate axis
/// is preferred where the patch is almost as long along it. The result is deterministic, and each patch lies within its
/// parent.
Division divide_patches(const TetMesh& mesh, const std::vector<Patch>& patches, int count);

/// Returns the centres of volume, 3 x patches [m].
Eigen::Matrix3Xd centers(const TetMesh& mesh, const std::vector<Patch>& patches);

/// Returns the covariance of a Gaussian process at places x_i, of standard deviation `std`, that is smooth over `length`
/// [m]. It is Matern of order 3/2 (Rasmussen & Williams 2006, eq. 4.17),
///   std^2 (1 + r) exp(-r), r = sqrt(3) |x_i - x_j| / length,
/// and positive definite for distinct places.
Eigen::MatrixXd smooth_covariance(const Eigen::Matrix3Xd& places, double length, double std);

}  // namespace tissue_stiffness
