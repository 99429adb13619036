#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// Force [N] that effects which are not linear exert at theta, beyond that at their absent values. Of finite strain the
/// part that is even in the displacement.
class ExtraForce {
 public:
  ExtraForce(const Model& model, const Eigen::VectorXd& theta);

  /// Those effects are absent at theta: the force is zero.
  bool absent() const { return absent_; }
  Eigen::VectorXd operator()(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

 private:
  Eigen::VectorXd difference(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

  const Model& model_;
  Model::Point with_, without_;  ///< the second: where those effects are absent
  bool absent_;
  bool even_ = false, loaded_ = false;  ///< finite strain is among them; some load follows the body under it
};

/// Whether the part may exert such a force.
bool adds_extra_force(const Model::Part& part);

}  // namespace tissue_stiffness
