#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Direct solver for symmetric positive definite matrices that share one sparsity pattern (CHOLMOD, LL^T). The pattern is
/// analysed once.
class SparseSolver {
 public:
  SparseSolver();
  ~SparseSolver();
  SparseSolver(SparseSolver&&) noexcept;
  SparseSolver& operator=(SparseSolver&&) noexcept;

  /// Computes the numerical factorisation; the first call also analyses the pattern. Throws NumericalError when the matrix
  /// is not positive definite. Large factorisations use all cores, others one. The number of BLAS threads is a setting of
  /// the whole process, and it changes the last digits of concurrent computations.
  void factorize(const SparseMatrix& matrix);
  bool ready() const;

  /// Returns the solution of A x = b for every column of b. It is thread safe, and so is solve_roughly.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// Returns the solution to about six digits, for iterations that correct it. For several columns it is several times
  /// faster.
  Eigen::MatrixXd solve_roughly(const Eigen::MatrixXd& b) const;
  /// Replaces the columns of x, right-hand sides, by solutions to about six digits. It is not thread safe. Its buffers are
  /// kept, so that a loop allocates no memory (where CHOLMOD is supernodal).
  void solve_roughly_in_place(Eigen::Ref<Eigen::MatrixXd> x);

  /// Returns the cost of a factorisation in solutions of one column, from their operations and their memory traffic.
  double cost() const;

  /// Returns the number of non-zeros of the factor.
  double factor_size() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Sets rows and columns of fixed degrees of freedom to zero and their diagonal to `diagonal`.
void fix_dofs(SparseMatrix& matrix, const std::vector<char>& fixed, double diagonal);

}  // namespace tissue_stiffness
