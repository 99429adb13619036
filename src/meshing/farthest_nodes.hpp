#pragma once

#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns at most `most` of these nodes, far from each other: each next node is the farthest from those before (Gonzalez
/// 1985).
std::vector<int> farthest_nodes(const TetMesh& mesh, const std::vector<int>& nodes, std::size_t most);

}  // namespace tissue_stiffness
