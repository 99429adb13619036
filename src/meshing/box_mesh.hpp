#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Makes a structured mesh of a box. Every cell is cut into six tetrahedra along its main diagonal (Kuhn's triangulation),
/// so that neighbouring cells conform. Corner (i, j, k) has the number i + (cells_x + 1) (j + (cells_y + 1) k). `size` [m],
/// each > 0; cell counts >= 1; order 1 (4 nodes) or 2 (10 nodes); `origin` is the corner of least coordinates [m]. Throws
/// InputError for other values.
TetMesh make_box_mesh(const Eigen::Vector3d& size, int cells_x, int cells_y, int cells_z, int order = 2,
                      const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

}  // namespace tissue_stiffness
