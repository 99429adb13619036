#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

enum class EstimateState { no_data, converging, converged, drifting, model_invalid };

/// "no_data", "converging", "converged", "drifting" or "model_invalid".
std::string to_string(EstimateState state);

/// One estimated quantity, in its own unit. Its distribution is log-normal where the quantity is positive by nature.
struct ParameterEstimate {
  std::string name;  ///< effect.parameter, with #2, #3, ... behind a repeated effect's name
  std::string unit;
  double mean = 0.0;
  double std = 0.0;
  double lower95 = 0.0;
  double upper95 = 0.0;
};

/// True of "elasticity.young_modulus", "elasticity#2.young_modulus", ...
bool is_young_modulus(const std::string& name);

/// Posterior after a frame.
struct Estimate {
  double time = 0.0;  ///< [s] on the recording's clock
  EstimateState state = EstimateState::no_data;
  std::vector<ParameterEstimate> parameters;
  Eigen::MatrixXd covariance;  ///< of the parameters in their own units
};

}  // namespace tissue_stiffness
