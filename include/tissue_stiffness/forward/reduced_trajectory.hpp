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

 private:
  struct Transition {
    Eigen::ArrayXd qq, qv, qf0, qf1, vq, vv, vf0, vf1;
  };
  void set_step(double step);
  Eigen::VectorXd modal_force(double time) const;

  const ReducedModel& reduced_;
  Eigen::VectorXd theta_;
  double time_;
  Eigen::MatrixXd modes_;
  Eigen::VectorXd omega_, damping_;  ///< damping_: alpha + beta omega^2 [1/s]
  Eigen::VectorXd constant_force_;   ///< gravity, modal
  Eigen::MatrixXd load_modes_;       ///< one column a load term, coefficient included
  std::vector<const LoadTerm*> load_terms_;
  Eigen::VectorXd q_, v_, force_;
  double step_ = -1.0;
  Transition transition_;
};

}  // namespace tissue_stiffness
