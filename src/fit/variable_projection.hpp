#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit/fit_problem.hpp"

namespace tissue_stiffness {

/// Returns w with the most probable values of the `linear` coordinates, in which the run is linear, while all others are
/// held (variable projection, Golub & Pereyra 1973, SIAM J. Numer. Anal. 10, p. 413). The rows have their robust weights at
/// w. Throws NumericalError when a run diverges.
Eigen::VectorXd variable_projection(const FitProblem& problem, const Eigen::VectorXd& w,
                                    const std::vector<Eigen::Index>& linear);

}  // namespace tissue_stiffness
