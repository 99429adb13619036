#pragma once

#include <Eigen/Core>
#include <functional>

#include "fem/neo_hookean.hpp"

namespace tissue_stiffness {

/// F = sum_a lambda_a n_a N_a^T: the principal stretches, their directions before (columns of `material`) and after the
/// deformation (columns of `spatial`).
struct PrincipalStretches {
  Eigen::Vector3d stretches;
  Eigen::Matrix3d material, spatial;
};
/// Throws NumericalError unless det F is positive.
PrincipalStretches principal_stretches(const Eigen::Matrix3d& f);

/// Returns the first Piola-Kirchhoff stress sum_a g_a n_a N_a^T of an isotropic energy with g_a = d psi / d lambda_a [Pa].
Eigen::Matrix3d principal_stress(const PrincipalStretches& at, const Eigen::Vector3d& g);
/// Returns its derivative, with the symmetric slopes d g_a / d lambda_b [Pa] (Ogden 1984, sec. 6.1.4). Where two stretches
/// are equal it takes the limit.
StressTangent principal_tangent(const PrincipalStretches& at, const Eigen::Vector3d& g, const Eigen::Matrix3d& slopes);

}  // namespace tissue_stiffness
