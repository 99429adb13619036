#pragma once

#include <map>
#include <string>

#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns the card of a diagnosis' effects: one line for each probable one, and a folded table of all. `units` are those
/// of their parameters, by EFFECT.PARAMETER. It is empty when no effect was tried.
std::string candidate_list(const Diagnosis& diagnosis, const std::map<std::string, std::string>& units);

}  // namespace tissue_stiffness
