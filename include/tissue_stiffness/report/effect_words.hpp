#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// "viscous_damping" -> "viscous damping".
std::string effect_title(const std::string& effect);

/// What one would see were this effect missing, as a clause: "the motion dies away faster than the model's, ...". A general
/// one for effects without words of their own.
std::string effect_sign(const std::string& effect);

/// "a, b and c", as titles.
std::string effect_list(const std::vector<std::string>& effects);

}  // namespace tissue_stiffness
