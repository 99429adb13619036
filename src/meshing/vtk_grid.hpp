#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

/// An unstructured grid of VTK.
struct VtkGrid {
  Eigen::Matrix3Xd points;
  std::vector<long long> offsets;  ///< first node of each cell in `nodes`, and the end
  std::vector<long long> nodes;
  std::vector<int> types;
};

/// Returns the tetrahedra: types 10 (4 nodes) and 24 (10 nodes), or 4 nodes where there are both. Cells of lower dimension
/// are skipped. `refuse` is called with what was found and what is allowed for other solids and for nodes out of range, and
/// throws.
TetFile tets_of_grid(VtkGrid grid, const std::function<void(const std::string&, const std::string&)>& refuse);

}  // namespace tissue_stiffness
