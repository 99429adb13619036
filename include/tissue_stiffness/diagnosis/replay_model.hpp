#pragma once

#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/replay.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// The free run of a model with these values of its parameters (others at their prior), for showing. Throws as Model does,
/// and NumericalError when the run diverges.
Replay replay_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                    const std::map<std::string, double>& parameters, const std::vector<double>& picture_stamps);

}  // namespace tissue_stiffness
