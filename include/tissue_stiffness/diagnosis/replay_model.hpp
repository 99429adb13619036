#pragma once

#include <vector>

#include "tissue_stiffness/fit/recording_fit.hpp"
#include "tissue_stiffness/types/replay.hpp"

namespace tissue_stiffness {

/// Returns the free run of a fitted model, for showing. Throws NumericalError when it diverges.
Replay replay_model(FittedModel& fitted, const std::vector<double>& picture_stamps);

}  // namespace tissue_stiffness
