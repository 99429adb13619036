#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

// These functions read sections of a model file. They throw InputError for a missing key or a value out of range. Unknown
// keys are left unread.

MeshSettings read_mesh(const Value& map, const std::string& directory);
std::vector<RegionSettings> read_regions(const Value& map);
std::vector<ObservationSettings> read_observations(const Value& list);
SegmentationSettings read_segmentation(const Value& map);

}  // namespace tissue_stiffness
