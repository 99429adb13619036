#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include "tissue_stiffness/nodes/messages.hpp"
#include "tissue_stiffness/types/stiffness_map.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// The surface at rest, coloured by Young's modulus on a logarithmic scale, dark blue where it is least over green to
/// yellow where it is largest (a range of a factor of 2 at least, about the middle); grey where the map is at its prior.
visualization_msgs::Marker map_marker(const StiffnessMap& map, const TetMesh& mesh, const std_msgs::Header& header);

StiffnessMapMessage to_message(const StiffnessMap& map, const std_msgs::Header& header);

}  // namespace tissue_stiffness
