#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tissue_stiffness/fem/discretisation.hpp"
#include "tissue_stiffness/fem/single_matrix.hpp"
#include "tissue_stiffness/fem/sparse_solver.hpp"
#include "tissue_stiffness/types/prolongation.hpp"

namespace tissue_stiffness {

/// Symmetric positive definite systems on a mesh that was refined from another one: conjugate gradients for many right-hand
/// sides, in single precision, preconditioned by V-cycles between the two (Briggs, Henson & McCormick, A Multigrid
/// Tutorial, 2000) that smooth by Chebyshev polynomials of the Jacobi iteration (Adams et al. 2003) and solve on the coarse
/// mesh what they leave. Takes a tenth of the memory and a third of the time of a factor and as many solutions as a reduced
/// basis needs. Thread safe.
class TwoGrid {
 public:
  /// `matrix`: three rows a node, both triangles; rows and columns of `fixed` degrees of freedom zero but for their
  /// diagonal. `nodes`: P; the coarser mesh's nodes are the first of the finer one. Throws NumericalError when the matrix
  /// is not positive definite.
  TwoGrid(SparseMatrix&& matrix, const std::vector<char>& fixed, const Prolongation& nodes);

  /// Columns of about A^-1 b, where nothing is fixed, within a few percent of their energy norm; empty when a factor is
  /// faster (for a nearly incompressible body it is).
  std::optional<Eigen::MatrixXd> solve(const Eigen::MatrixXd& b) const;

  const SparseMatrix& matrix() const { return matrix_; }
  /// P x, zero where a degree of freedom is fixed; P^T b; P^T S P of a symmetric S. P: of what is free.
  Eigen::MatrixXd to_fine(const Eigen::MatrixXd& x) const;
  Eigen::MatrixXd to_coarse(const Eigen::MatrixXd& b) const;
  SparseMatrix to_coarse(const SparseMatrix& s) const;
  /// (P^T A P)^-1 b, to about six digits.
  Eigen::MatrixXd solve_coarse(const Eigen::MatrixXd& b) const { return coarse_.solve_roughly(b); }

 private:
  class Iteration;
  void couple(const std::vector<char>& fixed, const Prolongation& nodes);
  void find_spectrum();

  SparseMatrix matrix_;
  SingleMatrix single_;                      ///< the same
  Prolongation prolongation_, restriction_;  ///< of degrees of freedom
  SparseSolver coarse_;
  Eigen::VectorXf inverse_diagonal_;
  double largest_ = 0.0;  ///< eigenvalue of D^-1 A, and a little more
  bool slow_ = false;     ///< V-cycles leave too much of smooth errors
};

}  // namespace tissue_stiffness
