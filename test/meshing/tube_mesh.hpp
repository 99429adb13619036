#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "meshing/elevate.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {

/// Returns a tube along z with flat sides, 10-node tetrahedra. Each hexahedron is cut into six tetrahedra around its
/// diagonal (Kuhn), so that neighbours match.
inline TetMesh tube_mesh(double inner, double outer, double length, int sides, int layers, int rings) {
  TetMesh mesh;
  const auto node = [=](int side, int layer, int ring) { return (ring * (layers + 1) + layer) * sides + side % sides; };
  mesh.corner_count = sides * (layers + 1) * (rings + 1);
  mesh.nodes.resize(3, mesh.corner_count);
  std::vector<Eigen::Vector4i> tets;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int layer = 0; layer <= layers; ++layer) {
      for (int side = 0; side < sides; ++side) {
        const double radius = inner + (outer - inner) * layer / layers, turn = 2.0 * M_PI * side / sides;
        mesh.nodes.col(node(side, layer, ring)) << radius * std::cos(turn), radius * std::sin(turn), length * ring / rings;
        if (ring == rings || layer == layers) continue;
        std::vector<int> steps{0, 1, 2};
        do {
          std::vector<int> at{side, layer, ring};
          Eigen::Vector4i tet;
          tet[0] = node(at[0], at[1], at[2]);
          for (int k = 0; k < 3; ++k) {
            ++at[static_cast<std::size_t>(steps[static_cast<std::size_t>(k)])];
            tet[k + 1] = node(at[0], at[1], at[2]);
          }
          tets.push_back(tet);
        } while (std::next_permutation(steps.begin(), steps.end()));
      }
    }
  }
  mesh.tets.resize(4, static_cast<Eigen::Index>(tets.size()));
  for (std::size_t t = 0; t < tets.size(); ++t) {
    Eigen::Vector4i& tet = tets[t];
    const auto edge = [&](int i) { return Eigen::Vector3d(mesh.nodes.col(tet[i]) - mesh.nodes.col(tet[0])); };
    if (edge(1).cross(edge(2)).dot(edge(3)) < 0.0) std::swap(tet[2], tet[3]);
    mesh.tets.col(static_cast<Eigen::Index>(t)) = tet;
  }
  elevate_to_quadratic(mesh);
  set_boundary_facets(mesh, "tube");
  return mesh;
}

}  // namespace tissue_stiffness
