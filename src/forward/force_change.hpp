#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "forward/full_model.hpp"

namespace tissue_stiffness {

/// The forces of a model at one theta, from which changes are counted.
struct UnchangedForces {
  UnchangedForces(const Model& model, const Eigen::VectorXd& theta);

  const Model& model;
  Eigen::VectorXd theta;
  ModelSystem system;
  SparseMatrix stiffness;  ///< the linear part
  Model::Point point;
};

/// What a move of theta changes in the balance of forces, f - C v - M a, over the length of the move. What stays the same
/// is not evaluated. It refers to the unchanged forces, which must not have relaxing branches.
class ForceChange {
 public:
  ForceChange(const UnchangedForces& unchanged, const Eigen::VectorXd& moved, double step);

  /// Returns all of it at an instant [N over the unit of theta]; a relaxing branch is not relaxed.
  Eigen::VectorXd whole(const DynamicState& at) const;
  /// These return its parts: the loads, and the nonlinear forces.
  Eigen::VectorXd load(double time) const;
  Eigen::VectorXd nonlinear(const DynamicState& at) const;

  /// Returns whether a relaxing branch appears. The next functions are for such a change only: its branches, their strain
  /// at an instant, and their force when they have relaxed so far.
  bool relaxes() const { return relaxing_ != nullptr; }
  const std::vector<Relaxation>& branches() const { return relaxing_->relaxations(); }
  Eigen::VectorXd strain(const DynamicState& at) const;
  Eigen::VectorXd relaxation(const DynamicState& at, const std::vector<Eigen::VectorXd>& relaxed) const;

  SparseMatrix mass, damping, stiffness;  ///< empty: they stay the same
  Eigen::VectorXd gravity;                ///< [N over the unit of theta]
  Eigen::Vector3d velocity;               ///< of the start
  bool laws = false, loads = false;       ///< whether nonlinear forces and loads change
  bool rates = false;                     ///< whether a nonlinear force that follows the velocity changes

 private:
  SparseMatrix difference(const SparseMatrix& now, const SparseMatrix& before) const;

  const UnchangedForces& unchanged_;
  double step_;
  Model::Point point_;
  std::unique_ptr<const ModelSystem> relaxing_;
};

}  // namespace tissue_stiffness
