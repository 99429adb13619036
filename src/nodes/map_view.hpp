#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include "nodes/messages.hpp"
#include "tissue_stiffness/types/stiffness_map.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns the surface at rest, coloured by Young's modulus on a logarithmic scale: from dark blue for the smallest over
/// green to yellow for the largest. The range is at least a factor of 2 about the middle. The surface is grey where the map
/// is at its prior.
visualization_msgs::Marker map_marker(const StiffnessMap& map, const TetMesh& mesh, const std_msgs::Header& header);

StiffnessMapMessage to_message(const StiffnessMap& map, const std_msgs::Header& header);

}  // namespace tissue_stiffness
