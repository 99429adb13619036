#pragma once

#include <vector>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// A symmetric matrix with three rows and columns for each node, in single precision. It has a 3 x 3 block for each pair of
/// coupled nodes. It is read once for many columns, and each row of these serves three sums.
class SingleMatrix {
 public:
  SingleMatrix() = default;
  explicit SingleMatrix(const SparseMatrix& matrix);

  int nodes() const { return static_cast<int>(begin_.size()) - 1; }
  /// Computes the node's three rows of A x, one after the other. x: rows of `columns` floats each, a multiple of
  /// kFloatWidth.
  void multiply(int node, const float* x, long columns, float* y) const;

 private:
  std::vector<int> begin_{0}, others_;  ///< start of each node's blocks; the node that each block couples to
  std::vector<float> blocks_;           ///< nine values for each block, row by row
};

}  // namespace tissue_stiffness
