#pragma once

#include <string>
#include <vector>

#include "../estimation/bar.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"

namespace tissue_stiffness {

/// The filmed bar has this modulus [Pa].
constexpr double kTruth = 20e3;

/// Films the bar with these effects hidden in it.
inline Recording film(const std::vector<std::string>& hidden, unsigned seed) {
  std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
  effects.insert(effects.end(), hidden.begin(), hidden.end());
  const Experiment experiment(box_settings(effects), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), kNoise, seed);
  return recording;
}

/// Diagnoses the recording with a model that knows the bar alone and begins at a wrong modulus.
inline Diagnosis diagnose_bar(const Recording& recording, const DiagnosisOptions& options) {
  return diagnose(box_settings(bar_under_gravity("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording, options);
}

}  // namespace tissue_stiffness
