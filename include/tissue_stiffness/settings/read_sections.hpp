#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

// Sections of a model file. Each throws InputError for a missing key and a value out of range; keys that nobody asked for
// are left unread.

MeshSettings read_mesh(const Value& map, const std::string& directory);
std::vector<RegionSettings> read_regions(const Value& map);
std::vector<ObservationSettings> read_observations(const Value& list);

}  // namespace tissue_stiffness
