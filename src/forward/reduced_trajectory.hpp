#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "forward/modal_step.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// Modal superposition in the reduced basis: q'' + (alpha + beta omega^2) q' + omega^2 (q + sum gamma (q - z)) = f with tau
/// z' = q - z for each relaxing branch. The steps use the exact transition for f linear over the step.
class ReducedTrajectory : public Trajectory {
 public:
  ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start, bool half_basis = false);
  /// Continues another run of the same model with other parameters.
  ReducedTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, const ReducedTrajectory& from);

  void advance(double time) override;
  double time() const override { return time_; }
  Eigen::VectorXd displacement() const override { return reduced_.displacement(coordinates()); }
  Eigen::VectorXd output() const override;
  /// Returns the reactions to prescribed motions [N], 3 rows each. `further` is added to the state: columns q, q', z...
  Eigen::VectorXd reactions() const { return reactions_with({}); }
  Eigen::VectorXd reactions_with(const Eigen::MatrixXd& further) const;
  /// Returns whether the body is at rest and no load of the model ever moves it.
  bool idle() const { return loads_.empty() && prescribed_.empty() && constant_force_.isZero(0.0) && state_.isZero(0.0); }
  Eigen::VectorXd velocity() const override { return reduced_.basis() * (modes_->shapes * state_.col(1)); }
  /// Returns the displacement in coordinates of the reduced basis.
  Eigen::VectorXd coordinates() const { return modes_->shapes * state_.col(0); }
  const std::shared_ptr<const ReducedModes>& modes() const { return modes_; }
  /// Returns the step of its modes, for the response to further forces.
  ModalStep step() const { return step_; }
  /// Returns the natural frequencies [rad/s], ascending.
  Eigen::VectorXd frequencies() const { return modes_->square.cwiseSqrt(); }

  /// These return the `count` lowest mode shapes, mass-normalised: 3n x count, and in the basis: basis size x count.
  Eigen::MatrixXd mode_shapes(int count) const { return reduced_.basis() * modes_->shapes.leftCols(count); }
  Eigen::MatrixXd modes_in_basis(int count) const { return modes_->shapes.leftCols(count); }
  Eigen::VectorXd modal_displacement() const { return state_.col(0); }
  Eigen::VectorXd modal_velocity() const { return state_.col(1); }
  /// Free motion of each mode over `span` [s]: q' = qq q + qv v, v' = vq q + vv v. qv and vv are also the response to a
  /// unit impulse. Relaxing branches are left out.
  struct FreeMotion {
    Eigen::ArrayXd qq, qv, vq, vv;
  };
  FreeMotion free_motion(double span, int count) const;
  /// Adds displacement and velocity, given in the basis, to the state.
  void correct(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity);

 private:
  struct Load {
    const LoadTerm* term;
    Eigen::VectorXd parameters;
    Eigen::VectorXd modal;  ///< with the coefficient
  };
  /// A component of a prescribed motion. Modes are damped and relax with the springs that impose it. So the springs' load
  /// is that of the motion g with the same damping and relaxation, g + beta g' + sum gamma (g - z), tau z' = g - z.
  struct Prescribed {
    Load load;
    double motion = 0.0;               ///< g at the last instant
    Eigen::VectorXd relaxed = {};      ///< z of each branch
    double before = 0.0, after = 0.0;  ///< load at both ends of the last step
  };
  void set_in_motion(const InitialMotion& initial);
  void collect_loads(const Eigen::VectorXd& theta);
  double value(const Load& load, double time) const {
    return reduced_.model().loads().value(*load.term, load.parameters, load_factor_, time);
  }
  Eigen::VectorXd modal_force(double time) const;
  Eigen::VectorXd modal_force_rate() const;
  void begin(Prescribed& motion) const;
  void follow(Prescribed& motion, double time, double step) const;
  bool fast(Eigen::Index mode) const { return modes_->square[mode] * last_.step * last_.step > 1.0; }
  Eigen::VectorXd inertia() const;

  const ReducedModel& reduced_;
  double time_, load_factor_;
  std::shared_ptr<const ReducedModes> modes_;
  Eigen::VectorXd constant_force_;  ///< modal force of gravity
  std::vector<Load> loads_;
  std::vector<Prescribed> prescribed_;
  double mass_damping_, stiffness_damping_;  ///< alpha [1/s], beta [s]
  std::vector<Relaxation> branches_;
  Eigen::VectorXd damping_;  ///< alpha + beta omega^2 [1/s]
  ReactionRows reaction_rows_;
  Eigen::VectorXd whole_force_;  ///< modal force at the last instant, with prescribed motions; empty before a step
  struct Inertia {
    Eigen::VectorXd mean;  ///< q'' + alpha q' over a step
    double step = 0.0;     ///< [s]
  };
  Inertia last_, before_last_;  ///< of the last two steps
  ModalStep step_;
  Eigen::MatrixXd state_;  ///< columns q, q', z...; a row for each mode
  Eigen::VectorXd force_;
};

/// Several reduced runs, advanced together.
class ReducedTrajectories : public SeparateTrajectories {
 public:
  ReducedTrajectories(const ReducedModel& reduced, std::vector<std::unique_ptr<Trajectory>> runs)
      : SeparateTrajectories(std::move(runs)), reduced_(reduced) {}
  void outputs(Eigen::MatrixXd& out) const override;
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const override {
    reduced_.recover(coordinates() * weights, sum);
  }

 private:
  Eigen::MatrixXd coordinates() const;

  const ReducedModel& reduced_;
};

}  // namespace tissue_stiffness
