#pragma once

#include <vector>

#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Returns whether an observation is among these already. A message that comes twice holds no more than one.
bool is_repeated(const Observation& observation, const std::vector<Observation>& others);

}  // namespace tissue_stiffness
