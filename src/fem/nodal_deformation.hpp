#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Deformation gradient of the material at each node: the mean over the elements around the node, weighted by their
/// volumes. It is the identity where this mean is turned inside out.
class NodalDeformation {
 public:
  explicit NodalDeformation(const Discretisation& fem);
  /// Finds the gradients, 3 x 3n with a matrix for each node, at displacement u (3n).
  void find(const Eigen::VectorXd& u, Eigen::Matrix3Xd& gradients) const;

 private:
  const Discretisation& fem_;
  // The gradient of a node is linear in its neighbours' displacements. These are, node by node, the start of its
  // neighbours in the list, the neighbours, and their mean shape gradients [1/m].
  std::vector<int> first_, neighbours_;
  Eigen::Matrix3Xd gradients_;
};

}  // namespace tissue_stiffness
