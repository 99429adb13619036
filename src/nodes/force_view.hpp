#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns the missing force at the instant when it is largest, as a needle from each of its nodes at rest. The longest
/// needle is a fifth of the body's size. Without a force the marker removes the previous one.
visualization_msgs::Marker force_marker(const MissingForce& force, const std_msgs::Header& header);

}  // namespace tissue_stiffness
