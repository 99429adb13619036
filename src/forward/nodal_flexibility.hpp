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
  NodalFlexibility(const SparseMatrix& stiffness, const std::vector<char>& fixed, std::vector<int> seen);

  /// Returns K^-1 between some of `seen`, given by their indices [m/N].
  Eigen::MatrixXd between(const std::vector<int>& forced) const;
  /// Returns the displacement at `seen` under forces at some of them [m].
  Eigen::VectorXd under(const std::vector<int>& forced, const Eigen::VectorXd& forces) const;
  /// Returns the displacement of all nodes under forces at `seen`, 3n [m].
  Eigen::VectorXd response(const Eigen::VectorXd& forces) const;
  /// Returns the factor c for which the stiffness is c times this one's; 0: there is none.
  double ratio(const SparseMatrix& stiffness, const std::vector<char>& fixed) const;

 private:
  SparseMatrix stiffness_;
  std::vector<char> fixed_;
  std::vector<int> seen_;
  SparseSolver solver_;
  using Columns = std::vector<const Eigen::VectorXd*>;
  Columns columns(const std::vector<int>& forced) const;
  mutable std::mutex mutex_;
  mutable std::map<int, Eigen::VectorXd> known_;  ///< columns of K^-1 at seen_, by index; none ever changes
};

}  // namespace tissue_stiffness
