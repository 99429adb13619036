#include "forward/full_residual.hpp"

#include <cmath>

#include "fem/products.hpp"

namespace tissue_stiffness {

FullResidual::FullResidual(const Model& model, const Eigen::VectorXd& theta)
    : system_(model, theta), compliance_(model.rest_stiffness(theta).diagonal()) {
  for (Eigen::Index i = 0; i < compliance_.size(); ++i) {
    const bool held = system_.fixed()[static_cast<std::size_t>(i)] != 0;
    compliance_[i] = held || !(compliance_[i] > 0.0) ? 0.0 : 1.0 / compliance_[i];
  }
}

double FullResidual::of(const HyperReducedTrajectory& run) const {
  const DynamicState at = run.balanced();
  Eigen::VectorXd r = system_.force(at.time, at.displacement, at.velocity);
  subtract_product(system_.mass(), at.acceleration, r);
  if (system_.damped()) subtract_product(system_.damping(), at.velocity, r);
  return std::sqrt(r.cwiseAbs2().dot(compliance_));
}

}  // namespace tissue_stiffness
