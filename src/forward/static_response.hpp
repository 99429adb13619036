#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "fem/sparse_solver.hpp"
#include "fem/two_grid.hpp"

namespace tissue_stiffness {

/// Computes K^-1 with some degrees of freedom held, by a factor. A large mesh that was refined from another one needs no
/// factor (see TwoGrid). A body that nothing holds gets a small part of its mass as stiffness. Thread safe.
class StaticResponse {
 public:
  /// `coarser`: null for a mesh that was not refined. Throws NumericalError when K is not positive definite.
  StaticResponse(SparseMatrix stiffness, const SparseMatrix& mass, std::vector<char> fixed, const Prolongation* coarser);

  Eigen::MatrixXd operator()(Eigen::MatrixXd loads) const;
  /// Solves in single precision where that is faster. The other vectors of a basis make up for the lost digits.
  Eigen::MatrixXd roughly(Eigen::MatrixXd loads) const;
  /// Returns null where a factor is used from the start.
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
