#pragma once

#include <functional>
#include <optional>

#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

/// Runs `make` in another process as run_apart does, and returns its tetrahedra. An InputError of it is thrown here.
/// Returns nothing when the process crashed or took longer than `seconds`.
std::optional<TetFile> make_tets_apart(
    const std::function<TetFile()>& make, unsigned seconds, const std::function<void()>& checkpoint = [] {});

}  // namespace tissue_stiffness
