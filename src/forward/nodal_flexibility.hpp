#pragma once

#include <Eigen/Core>
#include <map>
#include <mutex>
#include <vector>

#include "fem/sparse_solver.hpp"

namespace tissue_stiffness {

/// Static response of a held linear body to forces at some of its degrees of freedom, K^-1. Its columns are solved for when
/// they are first asked for, and kept. Thread safe.
class NodalFlexibility {
 public:
  /// `fixed`: a flag for each degree of freedom. `seen`: the degrees of freedom whose response is kept. Throws
  /// NumericalError when K is not positive definite, because nothing holds the body.
  NodalFlexibility(SparseMatrix stiffness, const std::vector<char>& fixed, std::vector<int> seen);

  /// Returns K^-1 between `seen` (rows) and some of them (columns, indices into `seen`) [m/N].
  Eigen::MatrixXd columns(const std::vector<int>& forced) const;
  /// Returns the displacement of all nodes under forces at `seen`, 3n [m].
  Eigen::VectorXd response(const Eigen::VectorXd& forces) const;
  /// Returns the factor c for which the stiffness is c times this one's; 0: there is none.
  double ratio(const SparseMatrix& stiffness, const std::vector<char>& fixed) const;

 private:
  SparseMatrix stiffness_;
  std::vector<char> fixed_;
  std::vector<int> seen_;
  SparseSolver solver_;
  mutable std::mutex mutex_;
  mutable std::map<int, Eigen::VectorXd> known_;  ///< columns, by index into seen_
};

}  // namespace tissue_stiffness
