#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// The missing force at the instant when it is largest: a needle from each of its nodes at rest, the longest a fifth of the
/// body's size. Without a force, a marker that removes the one before.
visualization_msgs::Marker force_marker(const MissingForce& force, const std_msgs::Header& header);

}  // namespace tissue_stiffness
