#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/fem/discretisation.hpp"

namespace tissue_stiffness {

/// How far the material turned at each node: the rotation in the polar decomposition of the deformation gradient's mean
/// over the elements around it. The identity where the mean is turned inside out.
class NodalRotations {
 public:
  explicit NodalRotations(const Discretisation& fem);
  /// 3 x 3n, a matrix a node, at displacement u (3n).
  void find(const Eigen::VectorXd& u, Eigen::Matrix3Xd& rotations) const;

 private:
  const Discretisation& fem_;
  // The mean deformation gradient of a node is linear in its neighbours' displacements: of each node in turn, those
  // neighbours' places in the list, which nodes they are, and their mean gradients [1/m].
  std::vector<int> first_, neighbours_;
  Eigen::Matrix3Xd gradients_;
};

}  // namespace tissue_stiffness
