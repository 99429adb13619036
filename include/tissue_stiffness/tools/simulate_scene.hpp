#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "tissue_stiffness/tools/scene.hpp"

namespace tissue_stiffness {

/// What a simulated recording holds.
struct SimulationSummary {
  int frames = 0;
  int nodes = 0;          ///< of the refined mesh
  double motion_rms = 0;  ///< of all nodes over all frames [m]
  double motion_max = 0;  ///< [m]
};

/// Runs a scene on its refined mesh and writes what its sensors and loads see to a bag. The first stamp is 1 700 000 000 s.
/// Throws InputError for a number that is not known, a mesh that does not come from a file, and what does not fit it.
SimulationSummary simulate_scene(const Scene& scene, const std::string& recording,
                                 const std::function<void(std::size_t done, std::size_t total)>& progress);

/// Writes every number of the scene's effects (YAML: `parameters: {effect.parameter: value}`) and the summary.
void write_truth(const Scene& scene, const SimulationSummary& summary, const std::string& file);

}  // namespace tissue_stiffness
