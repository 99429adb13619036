#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// These are all solutions of K x = lambda M x for symmetric matrices.
struct GeneralizedModes {
  Eigen::VectorXd values;   ///< n: lambda, ascending
  Eigen::MatrixXd vectors;  ///< n x n: one x in each column, with x^T M x = 1
};

/// Solves the generalised eigenvalue problem by divide and conquer (LAPACK's dsygvd: Anderson et al. 1999, LAPACK Users'
/// Guide, section 2.3.5.1). Only the lower triangles are read. It is thread safe. Throws NumericalError where the mass is
/// not positive definite, or where the iteration does not converge.
GeneralizedModes generalized_modes(Eigen::MatrixXd stiffness, Eigen::MatrixXd mass);

}  // namespace tissue_stiffness
