#pragma once

#include <Eigen/Core>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Returns basis^T K basis of a symmetric K, at the cost of K's own rows.
Eigen::MatrixXd project_matrix(const SparseMatrix& k, const Eigen::MatrixXd& basis);

/// Returns the motions of all nodes by a unit along each axis, 3n x 3.
Eigen::MatrixX3d unit_motion(Eigen::Index dofs);

}  // namespace tissue_stiffness
