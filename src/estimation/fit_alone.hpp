#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "estimation/agreement.hpp"
#include "estimation/joint_rows.hpp"

namespace tissue_stiffness {

/// Fits one of the recordings alone, from z on. Returns its likelihood there, scaled by its own misfit and temperature.
/// `test` gets the test of its residual.
LinearFit fit_alone(const JointRows& rows, std::size_t recording, const Eigen::VectorXd& z, MisfitTest& test);

/// Returns z with the parameters that only this recording has fitted to it, all else held.
Eigen::VectorXd with_own_parameters(const JointRows& rows, std::size_t recording, Eigen::VectorXd z);

}  // namespace tissue_stiffness
