#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// The model with `entries` appended to its effects, as add_effect does.
ModelSettings extend_model(ModelSettings model, const std::vector<std::string>& entries);

/// The text of a model file with `entries` appended to its effects. Files that it names relative to `directory` become
/// absolute, so that the text can be saved anywhere. Throws InputError for what is no model.
std::string extend_model(const std::string& text, const std::vector<std::string>& entries, const std::string& directory);

}  // namespace tissue_stiffness
