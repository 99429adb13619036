#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Proper orthogonal decomposition (Sirovich 1987): returns the directions of the snapshots (columns) that hold most of
/// their energy, the most energetic first. `products` are the snapshots' inner products. At most `most` directions are
/// returned, and no more than leave out the share `energy_left`.
Eigen::MatrixXd most_energetic(const Eigen::MatrixXd& snapshots, const Eigen::MatrixXd& products, double energy_left,
                               Eigen::Index most);

}  // namespace tissue_stiffness
