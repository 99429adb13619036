#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

inline std::string mesh_file(const std::string& name) {
  return std::string(TISSUE_STIFFNESS_TEST_DATA) + "/meshing/" + name;
}

/// What every mesh must satisfy, whatever it came from: positive tetrahedra, mid nodes shared and between their ends, and a
/// closed boundary with outward normals that encloses the same volume.
inline void expect_sound(const TetMesh& mesh, double volume, double tolerance) {
  EXPECT_NEAR(mesh_volume(mesh), volume, tolerance);
  std::map<std::pair<int, int>, int> mid_nodes;
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    ASSERT_GT(tet_volume(mesh, tet), 0.0);
    for (int e = 0; mesh.quadratic() && e < 6; ++e) {
      const auto& ends = kTetEdges[static_cast<std::size_t>(e)];
      const std::pair<int, int> edge = std::minmax(mesh.tets(ends[0], tet), mesh.tets(ends[1], tet));
      ASSERT_EQ(mid_nodes.emplace(edge, mesh.tets(4 + e, tet)).first->second, mesh.tets(4 + e, tet));
      ASSERT_GE(mesh.tets(4 + e, tet), mesh.corner_count);
      const Eigen::Vector3d a = mesh.nodes.col(edge.first), b = mesh.nodes.col(edge.second);
      ASSERT_LT((mesh.nodes.col(mesh.tets(4 + e, tet)) - 0.5 * (a + b)).norm(), 0.15 * (b - a).norm());
    }
  }
  ASSERT_EQ(mesh.node_count(), mesh.corner_count + static_cast<int>(mid_nodes.size()));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double enclosed = 0.0;
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const Eigen::Vector3d normal = facet_area_vector(mesh, f), x = mesh.nodes.col(mesh.facets(0, f));
    sum += normal;
    enclosed += normal.dot(x) / 3.0;
    double inside = 0.0;
    for (int i = 0; i < 4; ++i) inside += 0.25 * normal.dot(mesh.nodes.col(mesh.tets(i, mesh.facet_tet[f])) - x);
    ASSERT_LT(inside, 0.0) << "facet " << f << " points into its tetrahedron";
    for (int side = 0; mesh.quadratic() && side < 3; ++side) {
      const std::pair<int, int> edge = std::minmax(mesh.facets(side, f), mesh.facets((side + 1) % 3, f));
      ASSERT_EQ(mid_nodes.at(edge), mesh.facets(3 + side, f));
    }
  }
  EXPECT_LT(sum.norm(), 1e-10);
  EXPECT_NEAR(enclosed, mesh_volume(mesh), 1e-10 * volume);
}

/// Message of the InputError that `action` throws.
template <typename Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

}  // namespace tissue_stiffness
