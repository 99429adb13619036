#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Rotation of the material at each node. It is the rotation in the polar decomposition of the deformation gradient's mean
/// over the elements around the node. It is the identity where this mean is turned inside out.
class NodalRotations {
 public:
  explicit NodalRotations(const Discretisation& fem);
  /// Finds the rotations, 3 x 3n with a matrix for each node, at displacement u (3n).
  void find(const Eigen::VectorXd& u, Eigen::Matrix3Xd& rotations) const;

 private:
  const Discretisation& fem_;
  // The mean deformation gradient of a node is linear in its neighbours' displacements. These are, node by node, the start
  // of its neighbours in the list, the neighbours, and their mean gradients [1/m].
  std::vector<int> first_, neighbours_;
  Eigen::Matrix3Xd gradients_;
};

}  // namespace tissue_stiffness
