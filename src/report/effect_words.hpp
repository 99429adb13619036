#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// Returns an effect's title: "viscous_damping" -> "viscous damping".
std::string effect_title(const std::string& effect);

/// Returns what an observer would see if this effect were missing, as a clause: "the motion dies away faster than the
/// model's, ...". Effects without their own text get a general one.
std::string effect_sign(const std::string& effect);

/// Returns the titles as "a, b and c".
std::string effect_list(const std::vector<std::string>& effects);

}  // namespace tissue_stiffness
