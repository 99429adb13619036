#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// Returns the versions of the package, its compiler and the libraries that its numbers depend on, by name.
std::vector<std::pair<std::string, std::string>> versions();

}  // namespace tissue_stiffness
