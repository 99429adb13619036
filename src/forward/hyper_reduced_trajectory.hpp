#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "fem/generalized_alpha.hpp"
#include "forward/hyper_reduced_system.hpp"

namespace tissue_stiffness {

/// A run of a hyper-reduced model. Steps are those of GeneralizedAlpha in few coordinates, so each step may renew its
/// Jacobian. A step that diverges is cut in halves.
class HyperReducedTrajectory : public Trajectory {
 public:
  struct State {
    double time = 0.0;
    Eigen::VectorXd position, rate, acceleration;
  };
  HyperReducedTrajectory(const HyperReducedModel& reduced, const Eigen::VectorXd& theta, double start);
  /// Continues another run's motion.
  HyperReducedTrajectory(const HyperReducedModel& reduced, const Eigen::VectorXd& theta,
                         const HyperReducedTrajectory& from);

  void advance(double time) override;
  double time() const override { return state_.time; }
  Eigen::VectorXd displacement() const override;
  Eigen::VectorXd output() const override;
  Eigen::VectorXd velocity() const override;
  const Eigen::VectorXd& coordinates() const { return state_.position; }
  /// Returns the motion of every node at the weighted instants of the last step, where the forces are balanced;
  /// before the first step, at the start.
  DynamicState balanced() const;

 private:
  void initialise();
  void cut_step(double step, int depth);
  bool try_step(double step);
  void find_residual(double step, const Eigen::VectorXd& increment);
  void factorize(double step);

  const HyperReducedModel& reduced_;
  HyperReducedSystem system_;
  AlphaCoefficients alpha_;
  State state_, middle_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd stiffness_, damping_;
  Eigen::PartialPivLU<Eigen::MatrixXd> jacobian_;
};

}  // namespace tissue_stiffness
