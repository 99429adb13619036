#pragma once

#include <vector>

#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/types/replay.hpp"

namespace tissue_stiffness {

/// The free run of a fitted model, for showing. Throws NumericalError when it diverges.
Replay replay_model(Fitted& fitted, const std::vector<double>& picture_stamps);

}  // namespace tissue_stiffness
