#pragma once

#include <vector>

#include "tissue_stiffness/fem/discretisation.hpp"

namespace tissue_stiffness {

/// A symmetric matrix of three rows and columns a node in single precision, a 3 x 3 block for each pair of nodes that it
/// couples: read once for many columns, each row of which serves three sums.
class SingleMatrix {
 public:
  SingleMatrix() = default;
  explicit SingleMatrix(const SparseMatrix& matrix);

  int nodes() const { return static_cast<int>(begin_.size()) - 1; }
  /// The node's three rows of A x, one behind the other. x: rows of `columns` floats each, a multiple of kFloatWidth.
  void multiply(int node, const float* x, long columns, float* y) const;

 private:
  std::vector<int> begin_{0}, others_;  ///< of each node's blocks; which node each couples to
  std::vector<float> blocks_;           ///< nine a block, row by row
};

}  // namespace tissue_stiffness
