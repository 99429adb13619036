#pragma once

#include <Eigen/Core>

#include "fem/neo_hookean.hpp"

namespace tissue_stiffness {

/// A scalar of the deformation gradient F with its first and second derivative, in the layout of a StressTangent.
struct Invariant {
  double degree;  ///< as a polynomial of F
  double value;
  Eigen::Matrix3d gradient;
  StressTangent hessian;
};

/// What to compute of an invariant: its hessian costs the most, and a stress does without.
enum class Derivatives { first, second };

/// Returns I1 = tr C, I2 = ((tr C)^2 - tr C^2) / 2 and I4 = |F a|^2 of C = F^T F (Holzapfel 2000, eq. 5.91, 6.199).
Invariant first_invariant(const Eigen::Matrix3d& f, Derivatives order);
Invariant second_invariant(const Eigen::Matrix3d& f, Derivatives order);
Invariant fibre_invariant(const Eigen::Matrix3d& f, const Eigen::Vector3d& direction, Derivatives order);

/// Returns J^(-degree/3) times an invariant, J = det F, which is the same for every change of volume (Holzapfel 2000, eq.
/// 6.79, 6.109). Throws NumericalError unless J is positive.
Invariant isochoric(const Invariant& of, const Eigen::Matrix3d& f, Derivatives order);

/// Returns the outer product of two tensors as a StressTangent: entry (i + 3 J, k + 3 L) is a_iJ b_kL.
StressTangent outer(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

}  // namespace tissue_stiffness
