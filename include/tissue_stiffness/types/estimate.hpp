#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// States of an estimate:
/// * no_data: nothing was measured.
/// * converging: the interval has not settled, or little was learnt.
/// * converged: the interval has settled and the misfit passes its test.
/// * doubtful: the interval has settled, but the misfit or an input does not pass.
/// * drifting: a parameter is changing.
/// * stale: no measurement or load has come for longer than a stated time.
/// * model_invalid: no value of the parameters explains the motion.
enum class EstimateState { no_data, converging, converged, doubtful, drifting, stale, model_invalid };

/// Returns "no_data", "converging", "converged", "doubtful", "drifting", "stale" or "model_invalid".
std::string to_string(EstimateState state);

/// One estimated quantity in its own unit. Its distribution is log-normal where the quantity must be positive.
struct ParameterEstimate {
  std::string name;  ///< effect.parameter; a repeated effect's name gets #2, #3, ...
  std::string unit;
  double mean = 0.0;
  double std = 0.0;
  double lower95 = 0.0;
  double upper95 = 0.0;
};

/// Returns true for "elasticity.young_modulus", "elasticity#2.young_modulus", ...
bool is_young_modulus(const std::string& name);

/// One error of an input that the interval accounts for.
struct InputUncertainty {
  std::string input;  ///< a topic, or effect.parameter
  std::string error;  ///< gain, bias, noise, delay, hysteresis, direction, pose rotation, pose offset or value
  std::string unit;
  double tolerance = 0.0;  ///< 1 sigma, as stated or by default
  double mean = 0.0;       ///< estimated error: root mean square over its components; 0 if the error is only considered
  double std = 0.0;        ///< 1 sigma that remains of the tolerance
  /// Relative standard deviation of Young's modulus that this error causes, of the modulus that it moves most. Exact
  /// knowledge of the error would take its square off the modulus' variance.
  double modulus_std = 0.0;
};

/// Sources of a parameter's variance, as shares that add up to 1.
struct VarianceShares {
  double noise = 1.0, mesh = 0.0, loads = 0.0, constants = 0.0, model = 0.0;
};

/// Posterior distribution after a frame.
struct Estimate {
  double time = 0.0;  ///< [s] on the recording's clock
  EstimateState state = EstimateState::no_data;
  std::string state_reason;  ///< reason for the state, as a sentence
  std::vector<ParameterEstimate> parameters;
  std::vector<VarianceShares> variance;  ///< one for each parameter; empty: unknown
  std::vector<InputUncertainty> inputs;  ///< empty: every input is taken as exact, or none has been studied yet
  Eigen::MatrixXd covariance;            ///< covariance of the parameters in their own units
};

}  // namespace tissue_stiffness
