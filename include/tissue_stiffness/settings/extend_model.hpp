#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/effect_entry.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// The model with `entries`, as they are or as YAML, appended to its effects. Throws InputError for text that is no entry.
ModelSettings extend_model(ModelSettings model, const std::vector<EffectEntry>& entries);
ModelSettings extend_model(ModelSettings model, const std::vector<std::string>& entries);

/// The text of a model file with `entries` appended to its effects. Files that it names relative to `directory` become
/// absolute, so that the text can be saved anywhere. Throws InputError for what is no model.
std::string extend_model(const std::string& text, const std::vector<std::string>& entries, const std::string& directory);

}  // namespace tissue_stiffness
