#pragma once

#include <Eigen/Core>

#include "forward/model.hpp"

namespace tissue_stiffness {

/// Force [N] of nonlinear effects at theta, less their force at their absent values. Under finite strain only the part that
/// is even in the displacement is used.
class ExtraForce {
 public:
  ExtraForce(const Model& model, const Eigen::VectorXd& theta);

  /// Returns whether these effects are absent at theta, so that the force is zero.
  bool absent() const { return absent_; }
  Eigen::VectorXd operator()(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

 private:
  Eigen::VectorXd difference(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

  const Model& model_;
  Model::Point with_, without_;  ///< without_: these effects are absent
  bool absent_;
  bool even_ = false, loaded_ = false;  ///< the effects include finite strain; a load has a finite form
};

/// Returns whether the part may exert such a force.
bool adds_extra_force(const Model::Part& part);
/// Returns whether the part is linear under small strain; contact is not.
bool has_linear_form(const Model::Part& part);

}  // namespace tissue_stiffness
