#include "meshing/elevate.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "meshing/surface.hpp"

namespace tissue_stiffness {

void elevate_to_quadratic(TetMesh& mesh) {
  if (mesh.quadratic()) return;
  std::map<std::pair<int, int>, int> mid_nodes;
  Eigen::MatrixXi tets(10, mesh.tets.cols());
  tets.topRows(4) = mesh.tets;
  for (int tet = 0; tet < tets.cols(); ++tet) {
    for (int edge = 0; edge < 6; ++edge) {
      const auto [a, b] = std::minmax(tets(kTetEdges[edge][0], tet), tets(kTetEdges[edge][1], tet));
      const int next = mesh.corner_count + static_cast<int>(mid_nodes.size());
      tets(4 + edge, tet) = mid_nodes.emplace(std::make_pair(a, b), next).first->second;
    }
  }
  mesh.nodes.conservativeResize(3, mesh.corner_count + static_cast<int>(mid_nodes.size()));
  for (const auto& [edge, node] : mid_nodes) {
    mesh.nodes.col(node) = 0.5 * (mesh.nodes.col(edge.first) + mesh.nodes.col(edge.second));
  }
  mesh.tets = std::move(tets);
  if (mesh.facets.cols() > 0) set_boundary_facets(mesh, "mesh");
}

void drop_mid_nodes(TetMesh& mesh) {
  mesh.tets.conservativeResize(4, Eigen::NoChange);
  mesh.nodes.conservativeResize(Eigen::NoChange, mesh.corner_count);
  if (mesh.facets.cols() > 0) mesh.facets.conservativeResize(3, Eigen::NoChange);
}

}  // namespace tissue_stiffness
