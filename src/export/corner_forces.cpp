#include "export/corner_forces.hpp"

#include <vector>

#include "meshing/surface.hpp"

namespace tissue_stiffness {

Eigen::Matrix3Xd corner_forces(const TetMesh& mesh, const Eigen::Matrix3Xd& force) {
  Eigen::Matrix3Xd out = force.leftCols(mesh.corner_count);
  std::vector<char> done(static_cast<std::size_t>(mesh.node_count()), 0);
  for (int e = 0; mesh.quadratic() && e < mesh.tet_count(); ++e) {
    for (std::size_t k = 0; k < kTetEdges.size(); ++k) {
      const int middle = mesh.tets(4 + static_cast<Eigen::Index>(k), e);
      if (done[static_cast<std::size_t>(middle)] != 0) continue;
      done[static_cast<std::size_t>(middle)] = 1;
      for (const int end : kTetEdges[k]) out.col(mesh.tets(end, e)) += 0.5 * force.col(middle);
    }
  }
  return out;
}

}  // namespace tissue_stiffness
