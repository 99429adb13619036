#include "meshing/coarsen.hpp"

#include <string>

#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Corners = Eigen::Matrix<int, 4, 4>;  // a column for each child at a corner of the parent

InputError not_refined(const TetMesh& mesh, const std::string& why) {
  return {"mesh", std::to_string(mesh.tet_count()) + " tetrahedra, " + why,
          "the tetrahedra that the model's `mesh.refine` makes of its mesh"};
}

bool has(const Corners& corners, int child, int node) {
  return (corners.col(child).array() == node).any();
}

// Returns the corner that a child shares with no other one.
int own_corner(const Corners& corners, int child) {
  for (int i = 0; i < 4; ++i) {
    int children = 0;
    for (int other = 0; other < 4; ++other) children += has(corners, other, corners(i, child)) ? 1 : 0;
    if (children == 1) return corners(i, child);
  }
  return -1;
}

// Returns the corner that two children share: the middle of the parent's edge.
int common_corner(const Corners& corners, int a, int b) {
  for (int i = 0; i < 4; ++i) {
    if (has(corners, b, corners(i, a))) return corners(i, a);
  }
  return -1;
}

}  // namespace

TetMesh coarsen_mesh(const TetMesh& refined) {
  if (refined.tet_count() % 8 != 0) throw not_refined(refined, "no multiple of eight");
  TetMesh out;
  out.tets.resize(refined.quadratic() ? 10 : 4, refined.tet_count() / 8);
  for (int t = 0; t < out.tets.cols(); ++t) {
    const Corners corners = refined.tets.block<4, 4>(0, 8 * Eigen::Index{t});
    for (int i = 0; i < 4; ++i) out.tets(i, t) = own_corner(corners, i);
    for (int e = 0; out.tets.rows() == 10 && e < 6; ++e)
      out.tets(4 + e, t) = common_corner(corners, kTetEdges[e][0], kTetEdges[e][1]);
  }
  if (out.tets.minCoeff() < 0) throw not_refined(refined, "of which eight successive ones are not cut from one");
  out.corner_count = out.tets.topRows(4).maxCoeff() + 1;
  out.nodes = refined.nodes.leftCols(out.tets.maxCoeff() + 1);
  set_boundary_facets(out, "mesh before its refinement");
  return out;
}

}  // namespace tissue_stiffness
