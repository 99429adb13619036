#pragma once

#include <string>

namespace tissue_stiffness {

/// Returns the lower-case ending with its dot (".vtk"); empty when the file has none.
std::string file_ending(const std::string& file);

}  // namespace tissue_stiffness
