#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/forward/reduced_model.hpp"

namespace tissue_stiffness {

/// Modal superposition in the reduced basis: (K_r - omega^2 M_r) phi = 0, then q'' + (alpha + beta omega^2) q' + omega^2 q
/// = f, stepped with the exact transition for f linear over the step.
class ReducedTrajectory : public Trajectory {
 public:
  ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start);

  void advance(double time) override;
  double time() const override { return time_; }
  Eigen::VectorXd displacement() const override { return reduced_.basis_ * (modes_ * q_); }
  Eigen::VectorXd velocity() const override { return reduced_.basis_ * (modes_ * v_); }
  /// Natural frequencies [rad/s], ascending.
  const Eigen::VectorXd& frequencies() const { return omega_; }

  /// The `count` lowest modes' shapes, mass-normalised: 3n x count, and the same in the basis: basis size x count.
  Eigen::MatrixXd mode_shapes(int count) const { return reduced_.basis_ * modes_.leftCols(count); }
  Eigen::MatrixXd modes_in_basis(int count) const { return modes_.leftCols(count); }
  const Eigen::VectorXd& modal_displacement() const { return q_; }
  const Eigen::VectorXd& modal_velocity() const { return v_; }
  /// Free motion of each mode over `span` [s]: q' = qq q + qv v, v' = vq q + vv v; qv and vv answer a unit impulse too.
  struct FreeMotion {
    Eigen::ArrayXd qq, qv, vq, vv;
  };
  FreeMotion free_motion(double span, int count) const;
  /// Adds to the state; displacement and velocity in the basis.
  void correct(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity);

 private:
  struct Transition {
    Eigen::ArrayXd qq, qv, qf0, qf1, vq, vv, vf0, vf1;
  };
  void set_step(double step);
  Eigen::VectorXd modal_force(double time) const;

  const ReducedModel& reduced_;
  Eigen::VectorXd theta_;
  double time_;
  Eigen::MatrixXd modes_, to_modal_;  ///< to_modal_: inverse of modes_
  Eigen::VectorXd omega_, damping_;  ///< damping_: alpha + beta omega^2 [1/s]
  Eigen::VectorXd constant_force_;   ///< gravity, modal
  Eigen::MatrixXd load_modes_;       ///< one column a load term, coefficient included
  std::vector<const LoadTerm*> load_terms_;
  Eigen::VectorXd q_, v_, force_;
  double step_ = -1.0;
  Transition transition_;
};

}  // namespace tissue_stiffness
