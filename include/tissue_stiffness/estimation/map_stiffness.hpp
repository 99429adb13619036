#pragma once

#include <functional>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/stiffness_map.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// What a map is made from: copies, so that it can be made beside the estimator.
struct MapQuestion {
  ModelSettings settings;  ///< with `map`
  TetMesh mesh;
  std::vector<Frame> frames;      ///< in order of time; those before the body's rest are left out
  std::vector<LoadSample> loads;  ///< of the same run
  double first_stamp = 0.0;       ///< of the recording [s]
  Estimate estimate;              ///< of the model with one modulus: where the search begins
  /// Called before every frame of every run; what it throws ends the study.
  std::function<void()> checkpoint = [] {};
};

/// How Young's modulus varies over the body. Coarse to fine: the body is divided into 1, 2, 4, ... patches, up to
/// `map.cells`, each division within the last one's patches, and the model with a modulus E_r a patch is fitted to the
/// whole recording from the coarser fit on (Gauss-Newton, most probable parameters; all other parameters with it). Prior of
/// log E_r: common modulus as the model file has it, and about it a Gaussian process over the patches' centres, Matern 3/2
/// of standard deviation log(map.factor) and length `map.length`.
///
/// A division is kept when its evidence (Laplace: MacKay 2003, ch. 28) exceeds that of the last one kept by 5 or more, and
/// its fit is better by more than the mesh may be wrong; every division is tried, as a body may be uneven in a way that its
/// halves do not show. The finest patches take the modulus of the kept patch that they lie in. One is identified where that
/// modulus has a posterior standard deviation below half of log(map.factor), and the patch is seen: the data alone would
/// give it its own to that, all else known. Others stay at what the smooth prior makes of their neighbours. Intervals hold
/// the noise, as wide as the misfit asks, and half of what a finer mesh changes; not how E varies within a kept patch.
///
/// Throws InputError as require_map does, and when there is no frame; NumericalError when a run diverges.
StiffnessMap map_stiffness(const MapQuestion& question);

}  // namespace tissue_stiffness
