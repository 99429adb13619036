#pragma once

#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// Starts the prediction of n tracked points that an observation names by their ids: `measured` (3n) [m], `sigma` is
/// `noise` [m] in every row, `places` (3 x 3n) are the measured points. `predicted` and `nodes` have their sizes and no
/// values yet.
Prediction predict_named_points(const Observation& observation, double noise);

}  // namespace tissue_stiffness
