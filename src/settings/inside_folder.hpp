#pragma once

#include <string>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// Returns the path of a `file` that settings in `directory` name, which is relative to it or absolute.
std::string path_from(const std::string& directory, const std::string& file);

/// Returns the path of a `file` that a caller names, relative to `folder` or absolute. Throws InputError, naming `where`,
/// if it lies outside that folder, also by way of ".." or a link. `or_else` ends the sentence on what is allowed.
std::string require_inside(const std::string& file, const std::string& folder, const std::string& where,
                           const std::string& or_else = "");

/// Throws InputError for the first file outside `folder` that a key `file` names, at any depth of a model. An error in a
/// file is shown with its line, so a model from elsewhere could show any file.
void require_files_inside(Value model, const std::string& folder, const std::string& or_else = "");

/// Does the same for a model file or a scene and the folder that it lies in.
void require_files_inside(const std::string& yaml_file, const std::string& or_else);

}  // namespace tissue_stiffness
