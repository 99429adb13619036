#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// The corners of each node in a list of elements. With them sums over a node's elements need no lock, and their order does
/// not depend on threads. A corner's number is its element's position in the list times the nodes of an element, plus the
/// node's local number.
struct NodeCorners {
  NodeCorners() = default;
  /// `list`: columns of `elements` (nodes x elements).
  NodeCorners(const Eigen::MatrixXi& elements, const std::vector<int>& list, int node_count);

  std::vector<int> first;    ///< start of each node's corners in `corners`, and the end
  std::vector<int> corners;  ///< corners node by node, ascending
};

}  // namespace tissue_stiffness
