#pragma once

#include <string>
#include <vector>

#include "settings/effect_entry.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Returns the model with `entries`, given as objects or as YAML, appended to its effects. Throws InputError for text that
/// is not an entry.
ModelSettings extend_model(ModelSettings model, const std::vector<EffectEntry>& entries);
ModelSettings extend_model(ModelSettings model, const std::vector<std::string>& entries);

/// Returns the text of a model file with `entries` appended to its effects. Paths relative to `directory` become absolute,
/// so that the text can be saved anywhere. Throws InputError if the text is not a model.
std::string extend_model(const std::string& text, const std::vector<std::string>& entries, const std::string& directory);

}  // namespace tissue_stiffness
