#include "meshing/box_mesh.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "meshing/elevate.hpp"
#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Order of the axes along which each tetrahedron runs from the cell's first corner to its last. An odd order needs a swap.
struct Walk {
  std::array<int, 3> axes;
  bool odd;
};
constexpr std::array<Walk, 6> kWalks = {
    {{{0, 1, 2}, false}, {{1, 2, 0}, false}, {{2, 0, 1}, false}, {{0, 2, 1}, true}, {{1, 0, 2}, true}, {{2, 1, 0}, true}}};

void check(const Eigen::Vector3d& size, const Eigen::Vector3i& cells, int order) {
  if (!(size.minCoeff() > 0.0)) throw InputError("box mesh: size", std::to_string(size.minCoeff()), "above 0 m");
  if (cells.minCoeff() < 1) throw InputError("box mesh: cells", std::to_string(cells.minCoeff()), "1 or more");
  if (order != 1 && order != 2) throw InputError("box mesh: order", std::to_string(order), "1 or 2");
}

}  // namespace

TetMesh make_box_mesh(const Eigen::Vector3d& size, int cells_x, int cells_y, int cells_z, int order,
                      const Eigen::Vector3d& origin) {
  const Eigen::Vector3i cells(cells_x, cells_y, cells_z);
  check(size, cells, order);
  const Eigen::Vector3i stride(1, cells_x + 1, (cells_x + 1) * (cells_y + 1));
  TetMesh mesh;
  mesh.corner_count = stride.z() * (cells_z + 1);
  mesh.nodes.resize(3, mesh.corner_count);
  mesh.tets.resize(4, 6 * cells.prod());
  int tet = 0;
  for (int k = 0; k <= cells_z; ++k) {
    for (int j = 0; j <= cells_y; ++j) {
      for (int i = 0; i <= cells_x; ++i) {
        const Eigen::Vector3i place(i, j, k);
        const int first = place.dot(stride);
        mesh.nodes.col(first) = origin.array() + size.array() * place.cast<double>().array() / cells.cast<double>().array();
        if ((place.array() == cells.array()).any()) continue;
        for (const Walk& walk : kWalks) {
          const int second = first + stride[walk.axes[0]];
          const int third = second + stride[walk.axes[1]];
          mesh.tets.col(tet) << first, second, third, third + stride[walk.axes[2]];
          if (walk.odd) std::swap(mesh.tets(1, tet), mesh.tets(2, tet));
          ++tet;
        }
      }
    }
  }
  if (order == 2) elevate_to_quadratic(mesh);
  set_boundary_facets(mesh, "box mesh");
  return mesh;
}

}  // namespace tissue_stiffness
