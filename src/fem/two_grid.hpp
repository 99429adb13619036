#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/discretisation.hpp"
#include "fem/single_matrix.hpp"
#include "fem/sparse_solver.hpp"
#include "types/prolongation.hpp"

namespace tissue_stiffness {

/// Solver for symmetric positive definite systems on a mesh that was refined from another one. It uses conjugate gradients
/// for many right-hand sides in single precision, preconditioned by V-cycles between the two meshes (Briggs, Henson &
/// McCormick, A Multigrid Tutorial, 2000). They smooth by Chebyshev polynomials of the Jacobi iteration (Adams et al. 2003)
/// and solve for the remaining error on the coarse mesh. For a reduced basis this takes a tenth of the memory and a third
/// of the time of a factorisation with its solutions. Thread safe.
class TwoGrid {
 public:
  /// `matrix`: three rows a node, both triangles; the rows and columns of `fixed` degrees of freedom are zero except for
  /// their diagonal. `nodes`: P; the coarser mesh's nodes are the first of the finer one. Throws NumericalError when the
  /// matrix is not positive definite.
  TwoGrid(SparseMatrix&& matrix, const std::vector<char>& fixed, const Prolongation& nodes);

  /// Returns an approximation of A^-1 b for the free degrees of freedom, within a few percent in the energy norm of each
  /// column. Returns nothing when a factorisation is faster, as it is for a nearly incompressible body.
  std::optional<Eigen::MatrixXd> solve(const Eigen::MatrixXd& b) const;

  const SparseMatrix& matrix() const { return matrix_; }
  /// These return P x, zero where a degree of freedom is fixed; P^T b; and P^T S P of a symmetric S. P is limited to free
  /// degrees of freedom.
  Eigen::MatrixXd to_fine(const Eigen::MatrixXd& x) const;
  Eigen::MatrixXd to_coarse(const Eigen::MatrixXd& b) const;
  SparseMatrix to_coarse(const SparseMatrix& s) const;
  /// Returns (P^T A P)^-1 b to about six digits.
  Eigen::MatrixXd solve_coarse(const Eigen::MatrixXd& b) const { return coarse_.solve_roughly(b); }

 private:
  class Iteration;
  void couple(const std::vector<char>& fixed, const Prolongation& nodes);
  void find_spectrum();

  SparseMatrix matrix_;
  SingleMatrix single_;                      ///< matrix_ in single precision
  Prolongation prolongation_, restriction_;  ///< P and P^T for degrees of freedom
  SparseSolver coarse_;
  Eigen::VectorXf inverse_diagonal_;
  double largest_ = 0.0;  ///< largest eigenvalue of D^-1 A, with a safety factor
  bool slow_ = false;     ///< V-cycles leave too large a part of smooth errors
};

}  // namespace tissue_stiffness
