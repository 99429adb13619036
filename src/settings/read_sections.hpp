#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

// These functions read sections of a model file. They throw InputError for a missing key or a value out of range. Unknown
// keys are left unread.

MeshSettings read_mesh(const Value& map, const std::string& directory);
/// Throws InputError, naming `where`, for a region of `vertices`, which do not cover the nodes that a refinement adds.
/// `refinement` says what asks for it.
void require_refinable(const RegionSettings& region, const std::string& where, const std::string& refinement);
/// The mesh tells which shapes are allowed.
std::vector<RegionSettings> read_regions(const Value& map, const MeshSettings& mesh);
std::vector<ObservationSettings> read_observations(const Value& list);
SegmentationSettings read_segmentation(const Value& map);

}  // namespace tissue_stiffness
