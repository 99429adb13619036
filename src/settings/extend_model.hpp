#pragma once

#include <functional>
#include <string>
#include <vector>

#include "settings/effect_entry.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Returns the model with `entries`, given as objects or as YAML, appended to its effects. Throws InputError for text that
/// is not an entry.
ModelSettings extend_model(ModelSettings model, const std::vector<EffectEntry>& entries);
ModelSettings extend_model(ModelSettings model, const std::vector<std::string>& entries);

/// Returns the text of a model file with `entries` appended to its effects. `place` returns what the text shall call a file
/// that lies at an absolute path, so that the text can be saved elsewhere; it may also bring the file there. Throws
/// InputError if the text is not a model.
std::string extend_model(
    const std::string& text, const std::vector<std::string>& entries, const std::string& directory,
    const std::function<std::string(const std::string&)>& place = [](const std::string& path) { return path; });

}  // namespace tissue_stiffness
