#pragma once

#include <string>

#include "tissue_stiffness/types/stiffness_map.hpp"

namespace tissue_stiffness {

/// Returns a card of report.html as HTML: how many parts of the body are identified, and the modulus of each, softest
/// first.
std::string map_table(const StiffnessMap& map);

}  // namespace tissue_stiffness
