#pragma once

#include <string>
#include <vector>

#include "tools/manifest.hpp"

namespace tissue_stiffness {

/// Returns one table of all rows of a manifest in their order, as a CSV file: the manifest's columns, exit code, message
/// and state, frames, error, and mean, standard deviation and interval of each parameter. A row without results has empty
/// cells. The table does not depend on how the rows were shared out. `output` and `arguments` are those of the runs.
std::string merge_manifest(const Manifest& manifest, const std::string& output, const std::vector<std::string>& arguments);

}  // namespace tissue_stiffness
