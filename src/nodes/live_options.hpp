#pragma once

#include <string>

#include "nodes/model_check.hpp"
#include "tissue_stiffness/EstimatorConfig.h"
#include "tissue_stiffness/estimation/state_limits.hpp"
#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// What may change while the estimator node runs.
struct LiveOptions {
  ModelCheck::Options check;
  StateLimits limits;
  double colour_limit = 3.0;  ///< misfit from which the tracked surface is red, in standard deviations of the noise
};

/// Reads the options from the node's own parameters. `stale_after` [s] is the model's, for parameters without that key.
/// Throws InputError for a value out of its range (node_keys).
LiveOptions read_live_options(const Value& own, double stale_after);

/// Converts from the message of dynamic_reconfigure. Throws InputError for a value out of its range, named with `where`.
LiveOptions to_live_options(const EstimatorConfig& config, const std::string& where);
EstimatorConfig to_config(LiveOptions options);

/// Return the ends of the ranges.
EstimatorConfig least_config();
EstimatorConfig largest_config();

}  // namespace tissue_stiffness
