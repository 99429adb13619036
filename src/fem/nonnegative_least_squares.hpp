#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// Few columns of a matrix, with a positive weight for each.
struct SparseWeights {
  std::vector<Eigen::Index> columns;  ///< ascending
  Eigen::VectorXd weights;
  double left = 0.0;  ///< |b - A x| / |b|
};

/// Finds x >= 0 with |b - A x| <= tolerance |b|. It begins with no columns and adds them one after the other, so that few
/// weights are not zero (active set method: Lawson & Hanson 1974, ch. 23; stopped early: Farhat, Avery, Chapman & Cortial
/// 2014, algorithm 2). It ends short of the tolerance when no column makes the residual smaller, or with `most` columns.
SparseWeights nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double tolerance,
                                        Eigen::Index most);

}  // namespace tissue_stiffness
