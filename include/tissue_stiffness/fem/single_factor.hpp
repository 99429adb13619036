#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// A supernodal Cholesky factor in single precision, for solutions that an iteration corrects: half as much to read, once
/// for all columns of the right-hand side, and subtrees of the elimination on all cores. The sums do not depend on how many
/// cores there are.
class SingleFactor {
 public:
  /// Columns first[s] to first[s + 1] - 1 of L form supernode s, numbered in a postorder of the elimination tree. Its rows
  /// are ascending, its own columns first; its values are stored rows x columns, column by column.
  struct Layout {
    std::vector<int> permutation;  ///< row i of P A P^T is row permutation[i] of A
    std::vector<int> first;
    std::vector<int> rows;                 ///< of all supernodes, one after the other
    std::vector<std::size_t> row_start;    ///< of each supernode in `rows`, and the end
    std::vector<std::size_t> value_start;  ///< of each supernode in `values`, and the end
    Eigen::VectorXf values;
  };
  explicit SingleFactor(Layout layout);

  /// What a solution writes to on its way. Kept from one to the next, it asks the heap for memory only once.
  struct Workspace {
    Eigen::MatrixXf x;
    std::vector<std::vector<float>> beyond;     ///< of each task: its share of the rows behind it
    std::vector<std::vector<float>> supernode;  ///< of each task and of the rest: the rows of the supernode at hand
  };
  /// Replaces each column b of x by the solution of A x = b, to about six digits.
  void solve(Eigen::Ref<Eigen::MatrixXd> x, Workspace& workspace) const;

 private:
  struct Task {
    int begin, end;           ///< supernodes of a subtree
    std::vector<int> beyond;  ///< rows behind it that it reaches
  };
  struct Sweep;
  void plan();
  void add_task(int root, int begin);

  Layout l_;
  int size_ = 0;
  std::vector<int> inside_;  ///< of each supernode: its rows that are no index into its task's `beyond`
  std::vector<Task> tasks_;  ///< heaviest first
  std::vector<int> top_;     ///< supernodes of no task, ascending
};

}  // namespace tissue_stiffness
