#pragma once

#include "fit/recording_fit.hpp"

namespace tissue_stiffness {

/// Fits a given model to the recording's training frames, from where a scan of its prior fits best. Throws NumericalError
/// where it cannot be run.
FittedModel fit_given_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording);

}  // namespace tissue_stiffness
