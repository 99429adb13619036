#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "effects/load_error.hpp"
#include "forward/modal_step.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// Response of a reduced model at rest to the columns of a load's error basis, each of which is a separate load. It is what
/// one standard deviation of each error adds to the motion under the measured load.
class LoadErrorResponse {
 public:
  /// Starts at theta at `start` [s]. `course`: the measured load to which the model's load terms refer.
  LoadErrorResponse(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start,
                    std::shared_ptr<const Course> course, const LoadErrorBasis& basis);

  void advance(double time);
  /// Returns the amplitudes of the reduced model's modes at theta, modes x columns.
  Eigen::MatrixXd amplitudes() const;
  /// Returns what is left of each reaction [N] beyond the elastic force at these amplitudes, rows of a run's output x
  /// columns: inertia, damping, relaxation and the loads themselves.
  Eigen::MatrixXd further_reactions() const;

 private:
  Eigen::MatrixXd errors(double time) const;  ///< components x columns
  Eigen::MatrixXd modal_forces(double time) const { return patterns_ * errors(time); }

  const ReducedModel& reduced_;
  std::shared_ptr<const Course> course_;
  const LoadErrorBasis& basis_;
  double time_;
  std::shared_ptr<const ReducedModes> modes_;
  Eigen::MatrixXd patterns_;  ///< modal force of a unit load, modes x components
  ReactionRows reaction_rows_;
  bool prescribed_ = false;   ///< the load is a motion, and its force acts on no other region
  double stiffness_damping_;  ///< [s]
  ModalStep step_;
  Eigen::MatrixXd forces_;               ///< modes x columns
  std::vector<Eigen::MatrixXd> states_;  ///< displacement, velocity and branches, for each column
};

}  // namespace tissue_stiffness
