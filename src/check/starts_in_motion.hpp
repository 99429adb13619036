#pragma once

#include <algorithm>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Returns whether the body may be deformed, and move, when the recording begins.
inline bool starts_in_motion(const ModelSettings& settings) {
  return std::any_of(settings.effects.begin(), settings.effects.end(),
                     [](const EffectSettings& effect) { return effect.name == "initial_motion"; });
}

}  // namespace tissue_stiffness
