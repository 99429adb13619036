#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/forward/forward_model.hpp"

namespace tissue_stiffness {

/// A linear model in a basis of load-dependent Ritz vectors (Wilson, Yuan & Dickens 1982): repeated K^-1 M solves from the
/// static responses of the loads. In the basis every step is exact for loads that are linear in time (modal superposition),
/// so the time step is no source of error. Several moduli: K = sum E_r K_r, the basis holds K^-1 K_r x too.
class ReducedModel : public ForwardModel {
 public:
  /// Throws InputError for a nonlinear model, NumericalError for a body that nothing holds together.
  explicit ReducedModel(const Model& model, int basis_size = 48);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  std::string description() const override;

  /// M-orthonormal at the prior, 3n x basis size.
  const Eigen::MatrixXd& basis() const { return basis_; }

 private:
  friend class ReducedTrajectory;
  void build_basis(int size);
  void project();
  Eigen::MatrixXd start_vectors(const SparseMatrix& mass) const;

  const Model& model_;
  Eigen::MatrixXd basis_;
  std::vector<std::vector<Eigen::MatrixXd>> mass_, stiffness_;  ///< part x term, projected
  std::vector<std::vector<Eigen::VectorXd>> loads_;             ///< part x term, projected
  std::vector<std::vector<Eigen::MatrixX3d>> uniform_;          ///< mass term times a uniform unit motion, projected
};

}  // namespace tissue_stiffness
