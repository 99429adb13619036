#pragma once

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns the model of a body that need not be at rest when its measurements begin: with the effect `initial_motion`
/// beside the others. Its priors are as wide as the body allows: a tenth of its size, and its size a second (1 sigma).
/// `time.start` is 0, because no rest is waited for.
///
/// Throws InputError for what is only known since the rest: a load from a file, or the pose of a moved region or of a tool.
ModelSettings in_motion(ModelSettings model, const TetMesh& mesh);

/// Begins with the moduli that an earlier estimate of the same body found: each marginal distribution becomes the prior.
/// The state does not ask that they become better known than this.
void take_moduli(ModelSettings& model, const Estimate& known);

}  // namespace tissue_stiffness
