#include "meshing/vtk_grid.hpp"

#include <utility>

namespace tissue_stiffness {
namespace {

constexpr int kTet = 10, kQuadraticTet = 24;

// Points, lines, triangles, quadrilaterals and their quadratic variants bound the solid and are not part of it.
bool flat_cell(int type) {
  return (type >= 1 && type <= 9) || type == 21 || type == 22 || type == 23;
}

}  // namespace

TetFile tets_of_grid(VtkGrid grid, const std::function<void(const std::string&, const std::string&)>& refuse) {
  std::vector<std::size_t> solids;
  bool quadratic = true;
  for (std::size_t cell = 0; cell < grid.types.size(); ++cell) {
    const int type = grid.types[cell];
    const long long size = grid.offsets[cell + 1] - grid.offsets[cell];
    if (flat_cell(type)) continue;
    if ((type != kTet || size != 4) && (type != kQuadraticTet || size != 10)) {
      refuse(
          "cell " + std::to_string(cell) + " of type " + std::to_string(type) + " with " + std::to_string(size) + " nodes",
          "tetrahedra: type 10 with 4 nodes or type 24 with 10");
    }
    solids.push_back(cell);
    quadratic = quadratic && type == kQuadraticTet;
  }
  TetFile result{std::move(grid.points), Eigen::MatrixXi(quadratic ? 10 : 4, static_cast<Eigen::Index>(solids.size()))};
  for (Eigen::Index tet = 0; tet < result.tets.cols(); ++tet) {
    const auto first = static_cast<std::size_t>(grid.offsets[solids[static_cast<std::size_t>(tet)]]);
    for (Eigen::Index i = 0; i < result.tets.rows(); ++i) {
      const long long node = grid.nodes[first + static_cast<std::size_t>(i)];
      if (node < 0 || node >= result.nodes.cols()) {
        refuse("node " + std::to_string(node) + " in cell " + std::to_string(solids[static_cast<std::size_t>(tet)]),
               "0 to " + std::to_string(result.nodes.cols() - 1));
      }
      result.tets(i, tet) = static_cast<int>(node);
    }
  }
  return result;
}

}  // namespace tissue_stiffness
