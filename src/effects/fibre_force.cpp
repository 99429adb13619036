#include "effects/fibre_field.hpp"
#include "fem/invariants.hpp"

namespace tissue_stiffness {

double fibre_strain(const Eigen::Matrix3d& f, const Eigen::Vector3d& direction) {
  return 0.5 * ((f * direction).squaredNorm() - 1.0);
}

void add_fibre_stress(const FibreTension& tension, const Eigen::Vector3d& direction, const Eigen::Matrix3d& f,
                      Eigen::Matrix3d& stress) {
  stress += (tension.value * (f * direction)) * direction.transpose();
}

void add_fibre_tangent(const FibreTension& tension, const Eigen::Vector3d& direction, const Eigen::Matrix3d& f,
                       StressTangent& tangent) {
  const Invariant stretch = fibre_invariant(f, direction, Derivatives::second);
  tangent += 0.25 * tension.slope * outer(stretch.gradient, stretch.gradient) + 0.5 * tension.value * stretch.hessian;
}

}  // namespace tissue_stiffness
