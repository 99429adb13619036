#pragma once

#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Up to `most` of these nodes, far from each other: each next one is the farthest from those before (Gonzalez 1985).
std::vector<int> farthest_nodes(const TetMesh& mesh, const std::vector<int>& nodes, std::size_t most);

}  // namespace tissue_stiffness
