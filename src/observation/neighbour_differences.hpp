#pragma once

#include <Eigen/Core>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Returns the weights a_j of the differences below: each of their rows holds -1 for a point and a_j for its neighbours,
/// and depends on places alone. Parameters and rows are those of neighbour_differences.
SparseMatrix neighbour_weights(const Eigen::Matrix3Xd& places, const Eigen::VectorXd& used);

/// Returns a matrix D that tells a frame's noise from how far each row's error is from the plane through its neighbours.
/// What a model misses is smooth from one point of the body to the next, wherever it acts, and hardly counts. With the
/// weights a_j of an affine fit to the errors of the nearest points, evaluated at the point itself,
///   (D e)_i = (sum_j a_j s_j e_j - s_i e_i) / sqrt(sum_j a_j^2 s_j^2 + s_i^2)
/// has unit variance if the errors e, in units of their standard deviations s, are independent from point to point (a
/// polynomial weighting scheme: Munk, Bissantz, Wagner & Freitag 2005, J. R. Stat. Soc. B 67, 19-41). Consecutive rows at
/// one place are components of a vector, whose neighbours are the same components of other vectors.
///
/// places: 3 x rows [m]; sigma: [m]. Rows that are not `used` > 0 count nowhere. D has one row for each of at most 128
/// points' components, empty where nothing is to be told. It has no rows with fewer than six points.
SparseMatrix neighbour_differences(const Eigen::Matrix3Xd& places, const Eigen::VectorXd& sigma,
                                   const Eigen::VectorXd& used);
/// The same for weights that are known.
SparseMatrix neighbour_differences(const SparseMatrix& weights, const Eigen::VectorXd& sigma);

/// The weights of consecutive frames. Rows of the same nodes keep theirs: what a model misses is smooth on the body,
/// however the body moves.
class NeighbourWeights {
 public:
  /// nodes: of each row (Prediction::nodes). The result is valid until the next call.
  const SparseMatrix& of(const Eigen::VectorXi& nodes, const Eigen::Matrix3Xd& places, const Eigen::VectorXd& used);

 private:
  Eigen::VectorXi nodes_;
  Eigen::Array<bool, Eigen::Dynamic, 1> used_;
  SparseMatrix weights_;
};

}  // namespace tissue_stiffness
