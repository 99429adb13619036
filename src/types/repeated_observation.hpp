#pragma once

#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Returns whether two observations of a frame are equal in all that was measured. A message that comes twice holds no more
/// than one.
bool holds_repeats(const Frame& frame);

/// Leaves out the observations that equal an earlier one of the frame. Returns how many they are.
int leave_out_repeats(Frame& frame);

}  // namespace tissue_stiffness
