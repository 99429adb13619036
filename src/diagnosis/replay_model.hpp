#pragma once

#include <vector>

#include "fit/recording_fit.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// Returns the free run of a fitted model, for showing. Throws NumericalError when it diverges.
Replay replay_model(FittedModel& fitted, const std::vector<double>& picture_stamps);

}  // namespace tissue_stiffness
