#include "meshing/farthest_nodes.hpp"

#include <algorithm>
#include <limits>

namespace tissue_stiffness {

std::vector<int> farthest_nodes(const TetMesh& mesh, const std::vector<int>& nodes, std::size_t most) {
  std::vector<double> far(nodes.size(), std::numeric_limits<double>::infinity());
  std::vector<int> out;
  for (std::size_t next = 0; out.size() < std::min(most, nodes.size());) {
    out.push_back(nodes[next]);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      far[i] = std::min(far[i], (mesh.nodes.col(nodes[i]) - mesh.nodes.col(out.back())).squaredNorm());
    }
    next = static_cast<std::size_t>(std::max_element(far.begin(), far.end()) - far.begin());
  }
  return out;
}

}  // namespace tissue_stiffness
