#pragma once

#include <string>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// A model file as Python holds it: its settings, and the text that a diagnosis extends.
struct ModelFile {
  ModelSettings settings;
  std::string text;
  bool allow_outside = false;  ///< it may name files outside its folder
};

/// Reads a model file. Throws InputError as load_model does, and for a file outside the model's folder where that is not
/// allowed.
ModelFile read_model_file(const std::string& file, bool allow_outside);

/// Reads a model from YAML. Relative paths count from `directory`, and `name` stands for the file in messages.
ModelFile parse_model(const std::string& text, const std::string& directory, const std::string& name, bool allow_outside);

/// Returns the model with further entries of the list `effects`, given as YAML.
ModelFile with_effects(const ModelFile& model, const std::vector<std::string>& entries);

}  // namespace tissue_stiffness
