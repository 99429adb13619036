#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// A supernodal Cholesky factor in single precision, for solutions that an iteration corrects. It needs half the memory
/// traffic, is read once for all columns of the right-hand side, and solves subtrees of the elimination on all cores. The
/// sums do not depend on the number of cores.
class SingleFactor {
 public:
  /// Columns first[s] to first[s + 1] - 1 of L form supernode s, numbered in a postorder of the elimination tree. Its rows
  /// are ascending, with its own columns first. Its values are stored as rows x columns, column by column.
  struct Layout {
    std::vector<int> permutation;  ///< row i of P A P^T is row permutation[i] of A
    std::vector<int> first;
    std::vector<int> rows;                 ///< rows of all supernodes, one after the other
    std::vector<std::size_t> row_start;    ///< start of each supernode in `rows`, and the end
    std::vector<std::size_t> value_start;  ///< start of each supernode in `values`, and the end
    Eigen::VectorXf values;
  };
  explicit SingleFactor(Layout layout);

  /// Buffers of a solution. If they are kept between solutions, memory is allocated only once.
  struct Workspace {
    Eigen::MatrixXf x;
    std::vector<std::vector<float>> beyond;     ///< each task's contribution to the rows beyond its subtree
    std::vector<std::vector<float>> supernode;  ///< rows of the current supernode, for each task and for the rest
  };
  /// Replaces each column b of x by the solution of A x = b, accurate to about six digits.
  void solve(Eigen::Ref<Eigen::MatrixXd> x, Workspace& workspace) const;

 private:
  struct Task {
    int begin, end;           ///< range of supernodes of a subtree
    std::vector<int> beyond;  ///< rows beyond the subtree that it contributes to
  };
  struct Sweep;
  void plan();
  void add_task(int root, int begin);

  Layout l_;
  int size_ = 0;
  std::vector<int> inside_;  ///< for each supernode: number of rows that do not index its task's `beyond`
  std::vector<Task> tasks_;  ///< tasks, heaviest first
  std::vector<int> top_;     ///< supernodes that belong to no task, ascending
};

}  // namespace tissue_stiffness
