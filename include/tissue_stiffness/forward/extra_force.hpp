#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// Force [N] that effects which are not linear exert at theta, beyond that at their absent values. Of finite strain the
/// part that is even in the displacement.
class ExtraForce {
 public:
  ExtraForce(const Model& model, Eigen::VectorXd theta);

  /// Those effects are absent at theta: the force is zero.
  bool absent() const { return theta_ == without_; }
  Eigen::VectorXd operator()(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

 private:
  Eigen::VectorXd difference(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

  const Model& model_;
  Eigen::VectorXd theta_, without_;
  bool even_ = false, loaded_ = false;  ///< finite strain is among them; some load follows the body under it
};

/// Whether the part may exert such a force.
bool adds_extra_force(const Model::Part& part);

}  // namespace tissue_stiffness
