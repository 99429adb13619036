#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// Where each node stands in the elements of a list: sums over a node's elements then need no lock, in an order that does
/// not depend on threads. A corner is an element's place in the list times the nodes of an element, plus the node's local
/// number.
struct NodeCorners {
  NodeCorners() = default;
  /// `list`: columns of `elements` (nodes x elements).
  NodeCorners(const Eigen::MatrixXi& elements, const std::vector<int>& list, int node_count);

  std::vector<int> first;    ///< of each node in `corners`, and the end
  std::vector<int> corners;  ///< node by node, ascending
};

}  // namespace tissue_stiffness
