#pragma once

#include "check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Time at which the body was at rest [s], its first frame from then on, and the next frame if there is one.
struct FirstFrames {
  double rest_time = 0.0;
  const Frame& first;
  const Frame* second = nullptr;
};

/// Compares point clouds of the first frame with the mesh at rest.
/// * unit: points that spread 31.6 times as wide as the mesh, or a 31.6th of it, are in another unit than m.
/// * place: the rms distance D from the mesh is too large when D^2 > 9 (3 noise^2 + 3 offset_tolerance^2 +
///   (rotation_tolerance size)^2 + (scale_tolerance size)^2) + motion^2. Here `motion` is how far the body may have moved
///   since it was at rest, at the speed of the first two frames. The finding names the rigid motion after which the points
///   fit. If a scale within 20 % of 1 explains the points better, this is left to the effect `image_scale`.
/// Points outside the bounds of their cloud's field are the reader's errors and not checked here.
SetupFindings check_first_frame(const ModelSettings& settings, const TetMesh& mesh, const FirstFrames& frames);

}  // namespace tissue_stiffness
