#pragma once

#include <Eigen/Core>
#include <vector>

#include "forward/model.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// Converts N(mean, covariance) of the filter's coordinates to the parameters' own units. A log-normal's mean is exp(m +
/// s^2/2), its 95 % interval exp(m -+ 1.96 s). Fills in `parameters` and `covariance`.
Estimate summarise_posterior(const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& mean,
                             const Eigen::MatrixXd& covariance);

}  // namespace tissue_stiffness
