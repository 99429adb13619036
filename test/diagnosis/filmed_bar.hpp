#pragma once

#include <string>
#include <vector>

#include "../box_model.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {

/// The filmed bar has this modulus [Pa], and its vertices are seen with this noise [m].
constexpr double kTruth = 20e3, kNoise = 1e-4;

/// Returns the effects of a clamped bar of the given modulus under gravity.
inline std::vector<std::string> bar(const std::string& modulus) {
  return {"inertia: {density: 1000}", "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + modulus + "}",
          "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -3]}"};
}

/// Films the bar with these effects hidden in it.
inline Recording film(const std::vector<std::string>& hidden, unsigned seed) {
  std::vector<std::string> effects = bar("{prior: 20.0e3, factor: 3}");
  effects.insert(effects.end(), hidden.begin(), hidden.end());
  const Experiment experiment(box_settings(effects), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), kNoise, seed);
  return recording;
}

/// Diagnoses the recording with a model that knows the bar alone and begins at a wrong modulus.
inline Diagnosis diagnose_bar(const Recording& recording, const DiagnosisOptions& options) {
  return diagnose(box_settings(bar("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording, options);
}

}  // namespace tissue_stiffness
