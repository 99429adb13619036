#pragma once

#include <string>

#include "scene.hpp"

namespace tissue_stiffness {

/// Writes the linear problem of a scene for another program: `folder`/NAME.bin, little-endian, and problem.json with the
/// sizes. mass_*, stiffness_* (of unit modulus), observe_* are compressed sparse columns (data, indices, indptr; float64
/// and int32) over the degrees of freedom that nothing holds; weight [N]; measured, one row a frame, displacements [m].
void export_problem(const Scene& scene, int frames, const std::string& folder);

}  // namespace tissue_stiffness
