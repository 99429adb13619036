#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "tools/scene.hpp"

namespace tissue_stiffness {

/// Summary of a simulated recording.
struct SimulationSummary {
  int frames = 0;
  int nodes = 0;          ///< number of nodes of the refined mesh
  double motion_rms = 0;  ///< rms over all nodes and frames [m]
  double motion_max = 0;  ///< largest displacement of a node [m]
};

/// Throws InputError for a scene of more than 100 000 frames or 10 million time steps, which takes hours and gigabytes. It
/// is probably a wrong unit.
void require_moderate(const Scene& scene);

/// Runs a scene on its refined mesh and writes its loads and what its sensors observe to a bag. The first stamp is 1 700
/// 000 000 s. Throws InputError for a number that is not known, a mesh that does not come from a file, and settings that do
/// not fit it.
SimulationSummary simulate_scene(const Scene& scene, const std::string& recording,
                                 const std::function<void(std::size_t done, std::size_t total)>& progress);

/// Writes every number of the scene's effects (YAML: `parameters: {effect.parameter: value}`), and frames, motion_rms and
/// motion_max of the summary.
void write_truth(const Scene& scene, const SimulationSummary& summary, const std::string& file);

}  // namespace tissue_stiffness
