#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/fem/discretisation.hpp"

namespace tissue_stiffness {

/// Direct solver for symmetric positive definite matrices that share one sparsity pattern (CHOLMOD, LL^T).
/// The pattern is analysed once; a copy shares nothing.
class SparseSolver {
 public:
  SparseSolver();
  ~SparseSolver();
  SparseSolver(SparseSolver&&) noexcept;
  SparseSolver& operator=(SparseSolver&&) noexcept;

  /// Numerical factorisation; analyses the pattern at the first call. Throws NumericalError when not positive definite.
  /// Large ones take all cores, all others one: how many BLAS takes is a setting of the whole process, and changes the last
  /// digits of whatever works beside it.
  void factorize(const SparseMatrix& matrix);
  bool ready() const;

  /// Solution of A x = b for every column of b. Thread safe, as the next one is.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// The same to about six digits and several times faster for several columns, for iterations that correct it.
  Eigen::MatrixXd solve_roughly(const Eigen::MatrixXd& b) const;
  /// Replaces the columns of x, right-hand sides, in the same way. Not thread safe: works in buffers that stay, so that a
  /// loop asks the heap for nothing (where CHOLMOD is supernodal).
  void solve_roughly_in_place(Eigen::Ref<Eigen::MatrixXd> x);

  /// What a factorisation costs in solutions of one column, by their operations and their memory traffic.
  double cost() const;

  /// Non-zeros of the factor.
  double factor_size() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Sets rows and columns of fixed degrees of freedom to zero and their diagonal to `diagonal`.
void fix_dofs(SparseMatrix& matrix, const std::vector<char>& fixed, double diagonal);

}  // namespace tissue_stiffness
