#pragma once

#include <string>

namespace tissue_stiffness {

/// Returns the path of a `file` that a caller names, relative to `folder` or absolute. Throws InputError, naming `where`,
/// if it lies outside that folder, also by way of ".." or a link.
std::string require_inside(const std::string& file, const std::string& folder, const std::string& where);

}  // namespace tissue_stiffness
