#include <cmath>

#include "mesh_checks.hpp"
#include "meshing/planar_facets.hpp"
#include "meshing/quality.hpp"
#include "meshing/tetgen_mesher.hpp"
#include "meshing/triangle_surface.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

MeshSettings settings_for(const std::string& name, double edge) {
  MeshSettings settings;
  settings.file = mesh_file(name);
  settings.scale = 0.1;
  settings.max_edge_length = edge;
  return settings;
}

// A plate of n x n squares a side, whose flat parts a mesher may triangulate anew.
TriangleSurface fine_cube(int n) {
  TriangleSurface surface{Eigen::Matrix3Xd(3, 36 * n * n), Eigen::Matrix3Xi(3, 12 * n * n)};
  int corner = 0;
  const auto add = [&](const Eigen::Vector3d& x) {
    surface.triangles(corner % 3, corner / 3) = corner;
    surface.vertices.col(corner++) = x;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3), v = Eigen::Vector3d::Unit((axis + 2) % 3);
    for (const double level : {0.0, 1.0}) {
      for (int i = 0; i < n * n; ++i) {
        const auto at = [&](int a, int b) {
          return Eigen::Vector3d(level * Eigen::Vector3d::Unit(axis) + (u * (i % n + a) + v * (i / n + b)) / n);
        };
        const bool out = level > 0.5;
        for (const auto& [a, b] : {std::pair<int, int>{0, 0}, {out, !out}, {1, 1}}) add(at(a, b));
        for (const auto& [a, b] : {std::pair<int, int>{0, 0}, {1, 1}, {!out, out}}) add(at(a, b));
      }
    }
  }
  return weld(surface, 1e-9);
}

TEST(TriangleSurface, WeldsAndEncloses) {
  const TriangleSurface surface = fine_cube(4);
  EXPECT_EQ(surface.vertex_count(), 6 * 16 + 2);
  EXPECT_NO_THROW(check_watertight(surface, "cube"));
  EXPECT_NEAR(enclosed_volume(surface), 1.0, 1e-12);
  EXPECT_NEAR(winding_number(surface, {0.5, 0.4, 0.3}), 1.0, 1e-12);
  EXPECT_NEAR(winding_number(surface, {1.5, 0.4, 0.3}), 0.0, 1e-12);
}

TEST(PlanarFacets, ForgetHowPlanesWereCut) {
  const PlanarFacets facets = merge_coplanar(fine_cube(5), 1e-9);
  EXPECT_EQ(facets.facets.size(), 6u);
  EXPECT_EQ(facets.vertices.cols(), 8);
  for (const auto& facet : facets.facets) EXPECT_EQ(facet.loops.front().size(), 4u);
}

TEST(PlanarFacets, KeepHoles) {
  PlanarFacets facets = merge_coplanar(load_surface(mesh_file("frame.obj"), 1.0), 1e-9);
  EXPECT_EQ(facets.facets.size(), 2u + 4u + 4u);
  EXPECT_EQ(facets.vertices.cols(), 16);
  subdivide_edges(facets, 0.4);
  const TriangleSurface surface = triangulate(facets);
  EXPECT_NO_THROW(check_watertight(surface, "frame"));
  EXPECT_NEAR(enclosed_volume(surface), 8.0, 1e-12);
  double area = 0.0;
  for (int t = 0; t < surface.triangle_count(); ++t) area += triangle_area_vector(surface, t).norm();
  EXPECT_NEAR(area, 2.0 * 8.0 + 12.0 + 4.0, 1e-12) << "no triangle lies over a hole or over another";
}

TEST(PlanarFacets, SubdivideSharedEdgesOnce) {
  PlanarFacets facets = merge_coplanar(fine_cube(1), 1e-9);
  subdivide_edges(facets, 0.25);
  EXPECT_EQ(facets.vertices.cols(), 8 + 12 * 3);
}

struct Body {
  std::string file;
  double volume;
};
class SurfaceFiles : public testing::TestWithParam<Body> {};

TEST_P(SurfaceFiles, AreFilled) {
  if (!has_tetgen()) GTEST_SKIP() << "this build is without TetGen";
  for (const double edge : {0.0, 0.05, 0.03}) {
    const TetMesh mesh = build_mesh(settings_for(GetParam().file, edge));
    expect_sound(mesh, GetParam().volume, 1e-9 * GetParam().volume);
    if (edge == 0.0) continue;
    const MeshQuality quality = measure_quality(mesh);
    EXPECT_LT(quality.mean_edge_length, 1.1 * edge);
    EXPECT_GT(quality.mean_edge_length, 0.6 * edge) << "the cavity's walls are thin";
    EXPECT_GT(quality.least_radius_ratio, 0.1);
    EXPECT_GT(quality.least_dihedral_angle, 8.0 * M_PI / 180.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, SurfaceFiles,
                         testing::Values(Body{"cube_ascii.stl", 1e-3}, Body{"cube_binary.stl", 1e-3},
                                         Body{"cube.ply", 1e-3}, Body{"cube.obj", 1e-3},
                                         Body{"cube_mixed_orientation.obj", 1e-3}, Body{"cube_with_cavity.obj", 0.875e-3},
                                         Body{"frame.obj", 8e-3}));

TEST(FillSurface, SizeFollowsTheLengthAskedForAndNotTheSurface) {
  if (!has_tetgen()) GTEST_SKIP() << "this build is without TetGen";
  const TetFile coarse = fill_surface(fine_cube(40), 0.25, false, "cube");
  const TetFile same = fill_surface(fine_cube(1), 0.25, false, "cube");
  EXPECT_LT(coarse.tets.cols(), 1500);
  const auto count = static_cast<double>(same.tets.cols());
  EXPECT_NEAR(static_cast<double>(coarse.tets.cols()), count, 0.2 * count);
}

struct Refused {
  std::string file, part;
};
class RefusedSurfaces : public testing::TestWithParam<Refused> {};

TEST_P(RefusedSurfaces, NameFileAndPlace) {
  const std::string message = refusal([] { build_mesh(settings_for(GetParam().file, 0.05)); });
  expect_contains(message, GetParam().file);
  expect_contains(message, GetParam().part);
}

INSTANTIATE_TEST_SUITE_P(
    Bad, RefusedSurfaces,
    testing::Values(Refused{"cube_open.obj", "an open surface, an edge from (0.1, 0, 0) m to (0.1, 0, 0.1) m"},
                    Refused{"cubes_sharing_edge.obj", "an edge from (0.1, 0.1, 0) m to (0.1, 0.1, 0.1) m with 4 triangles"},
                    Refused{"no_such_file.stl", "no readable file"}, Refused{"no_such_file.ply", "no readable file"},
                    Refused{"box.node.txt", "ending '.txt'"}));

TEST(FillSurface, RefusesLengthsThatNeverEnd) {
  MeshSettings settings;
  settings.source = MeshSettings::Source::file;
  settings.file = mesh_file("cube.obj");
  for (const double length : {1e-12, 1e-4, 2e-3}) {
    settings.max_edge_length = length;
    const std::string message = refusal([&] { build_mesh(settings); });
    expect_contains(message, "max_edge_length");
    expect_contains(message, "at least 0.0");
  }
}

TEST(FillSurface, RefusesSurfacesThatCross) {
  const std::string message = refusal([] { build_mesh(settings_for("cubes_crossing.obj", 0.05)); });
  expect_contains(message, has_tetgen() ? "crosses itself near (" : "TISSUE_STIFFNESS_TETGEN");
}

TEST(SurfaceChecks, RefuseEmptyAndNotFinite) {
  TriangleSurface surface = fine_cube(1);
  surface.vertices(1, 2) = std::nan("");
  expect_contains(refusal([&] { check_watertight(surface, "cube"); }), "vertex 2 with a coordinate that is not finite");
  expect_contains(refusal([] { check_watertight({}, "cube"); }), "no triangles");
}

}  // namespace
}  // namespace tissue_stiffness
