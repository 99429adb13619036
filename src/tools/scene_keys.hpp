#pragma once

#include <string>
#include <vector>

#include "settings/key_spec.hpp"

namespace tissue_stiffness {

/// Returns every key below `simulation` of a scene file; `*` stands for a topic.
const std::vector<KeySpec>& scene_keys();

/// Returns the key with this path below "simulation.".
const KeySpec& scene_key(const std::string& path);

}  // namespace tissue_stiffness
