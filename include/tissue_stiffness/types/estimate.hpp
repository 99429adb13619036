#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// no_data: nothing was measured. converging: the interval has not settled, or little was learnt. converged: the interval
/// has settled and the misfit passes its test. doubtful: settled, but the misfit or an input does not pass. drifting: a
/// parameter is changing. stale: no measurement or load has come for longer than a stated time. model_invalid: no value of
/// the parameters explains the motion.
enum class EstimateState { no_data, converging, converged, doubtful, drifting, stale, model_invalid };

/// "no_data", "converging", "converged", "doubtful", "drifting", "stale" or "model_invalid".
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

/// One error of an input that the interval takes into account.
struct InputUncertainty {
  std::string input;  ///< topic, or effect.parameter
  std::string error;  ///< gain, bias, noise, delay, hysteresis, direction, pose rotation, pose offset or value
  std::string unit;
  double tolerance = 0.0;  ///< 1 sigma, as stated or by default
  double mean = 0.0;       ///< as estimated: root mean square over its components; 0 for what is only considered
  double std = 0.0;        ///< that is left of the tolerance
};

/// Where a parameter's variance comes from: shares that add up to 1.
struct VarianceShares {
  double noise = 1.0, mesh = 0.0, loads = 0.0, constants = 0.0, model = 0.0;
};

/// Posterior after a frame.
struct Estimate {
  double time = 0.0;  ///< [s] on the recording's clock
  EstimateState state = EstimateState::no_data;
  std::string state_reason;  ///< why it is so, a sentence
  std::vector<ParameterEstimate> parameters;
  std::vector<VarianceShares> variance;  ///< of each parameter; empty: not known
  std::vector<InputUncertainty> inputs;  ///< empty: every input is taken as exact, or nothing was studied yet
  Eigen::MatrixXd covariance;            ///< of the parameters in their own units
};

}  // namespace tissue_stiffness
