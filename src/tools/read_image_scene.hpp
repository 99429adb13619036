#pragma once

#include "tools/scene.hpp"

namespace tissue_stiffness {

/// Reads the camera or the B-mode sector of an observed contour, as described at Scene. Throws InputError.
ImageScene read_image_scene(const Value& map, const ObservationSettings& observation);

}  // namespace tissue_stiffness
