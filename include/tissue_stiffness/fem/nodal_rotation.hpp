#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/fem/discretisation.hpp"

namespace tissue_stiffness {

/// How far the material turned at each node: the rotation in the polar decomposition of the deformation gradient's mean
/// over the elements around it. 3 x 3n, a matrix a node; the identity where the mean is turned inside out.
Eigen::Matrix3Xd nodal_rotations(const Discretisation& fem, const Eigen::VectorXd& u);

}  // namespace tissue_stiffness
