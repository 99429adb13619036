#pragma once

namespace tissue_stiffness {

/// The limits of an estimate's states that a user may set. The other ones follow from the statistics of the measurement.
struct StateLimits {
  double converged_within = 0.2;  ///< relative standard deviation up to which an estimate may be `converged`
  double stale_after = 2.0;       ///< time without a measurement or a load after which the estimate is stale [s]
};

}  // namespace tissue_stiffness
