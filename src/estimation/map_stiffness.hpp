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

/// A map question holds copies of all that a map is made from, so that the map can be made in the background.
struct MapQuestion {
  ModelSettings settings;  ///< with `map`
  TetMesh mesh;
  std::vector<Frame> frames;      ///< in order of time; frames before the body's rest are left out
  std::vector<LoadSample> loads;  ///< of the run that the frames are from
  double first_stamp = 0.0;       ///< of the recording [s]
  Estimate estimate;              ///< by the model with one modulus; the search begins there
  /// It is called before every frame of every run; what it throws ends the study.
  std::function<void()> checkpoint = [] {};
};

/// Maps how Young's modulus varies over the body, from coarse to fine. The body is divided into 1, 2, 4, ... patches, up to
/// `map.cells`, each division within the last one's patches. The model with a modulus E_r a patch is fitted to the whole
/// recording from the coarser fit on (Gauss-Newton, most probable parameters; all other parameters with it). The prior of
/// log E_r is the common modulus of the model file, and about it a Gaussian process over the patches' centres. That process
/// is Matern 3/2 of standard deviation log(map.factor) and length `map.length`.
///
/// A division is kept when its evidence (Laplace: MacKay 2003, ch. 28) exceeds that of the last one kept by 5 or more. Its
/// fit also has to be better by more than the mesh may be wrong. Every division is tried, because a body may be uneven in a
/// way that its halves do not show. The finest patches take the modulus of the kept patch that they lie in. A finest patch
/// is identified where that modulus has a posterior standard deviation below half of log(map.factor), and the patch is
/// seen. It is seen when the data alone would give its own modulus that precisely, all else known. Others stay at what the
/// smooth prior makes of their neighbours. Intervals hold the noise, as wide as the misfit asks, and half of what a finer
/// mesh changes. They do not hold how E varies within a kept patch.
///
/// Throws InputError as require_map does, and when there is no frame. Throws NumericalError when a run diverges.
StiffnessMap map_stiffness(const MapQuestion& question);

}  // namespace tissue_stiffness
