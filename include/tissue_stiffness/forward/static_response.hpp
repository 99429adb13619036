#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "tissue_stiffness/fem/sparse_solver.hpp"
#include "tissue_stiffness/fem/two_grid.hpp"

namespace tissue_stiffness {

/// K^-1 with some degrees of freedom held, by a factor; beside the mesh that a large one was refined from, without (see
/// TwoGrid). A body that nothing holds gets a trace of its mass for stiffness. Thread safe.
class StaticResponse {
 public:
  /// `coarser`: null for a mesh that was not refined. Throws NumericalError when K is not positive definite.
  StaticResponse(SparseMatrix stiffness, const SparseMatrix& mass, std::vector<char> fixed, const Prolongation* coarser);

  Eigen::MatrixXd operator()(Eigen::MatrixXd loads) const;
  /// In single precision where that is faster: what a basis lacks to the last digits, its other vectors hold.
  Eigen::MatrixXd roughly(Eigen::MatrixXd loads) const;
  /// Null where there is a factor.
  const TwoGrid* grids() const { return grids_.get(); }

 private:
  void hold(Eigen::MatrixXd& loads) const;
  std::optional<Eigen::MatrixXd> between_meshes(const Eigen::MatrixXd& loads) const;

  std::vector<char> fixed_;
  std::unique_ptr<const TwoGrid> grids_;
  mutable std::mutex busy_;
  mutable std::atomic<bool> factorised_{false};
  mutable SparseSolver solver_;
};

}  // namespace tissue_stiffness
