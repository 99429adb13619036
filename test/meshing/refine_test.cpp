#include "meshing/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "meshing/box_mesh.hpp"
#include "meshing/coarsen.hpp"
#include "meshing/surface.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

TEST(Refine, CutsEachTetrahedronIntoEightOfTheSameVolume) {
  for (const int order : {1, 2}) {
    const TetMesh coarse = make_box_mesh({0.1, 0.02, 0.03}, 3, 2, 2, order);
    const TetMesh fine = refine_mesh(coarse);
    ASSERT_EQ(fine.tet_count(), 8 * coarse.tet_count());
    EXPECT_EQ(fine.facet_count(), 4 * coarse.facet_count());
    EXPECT_EQ(fine.quadratic(), coarse.quadratic());
    EXPECT_NEAR(mesh_volume(fine), mesh_volume(coarse), 1e-18);
    const double piece = mesh_volume(coarse) / coarse.tet_count() / 8.0;
    for (int t = 0; t < fine.tet_count(); ++t) EXPECT_NEAR(tet_volume(fine, t), piece, 1e-6 * piece);
  }
}

TEST(Refine, KeepsTheNumbersOfAllNodes) {
  const TetMesh coarse = make_box_mesh({1.0, 1.0, 1.0}, 2, 2, 2, 2);
  const TetMesh fine = refine_mesh(coarse);
  EXPECT_EQ(fine.corner_count, coarse.node_count());
  EXPECT_EQ(fine.nodes.leftCols(coarse.node_count()), coarse.nodes);
}

TEST(Refine, FollowsCurvedEdges) {
  TetMesh coarse = make_box_mesh({1.0, 1.0, 1.0}, 2, 1, 1, 2);
  const auto bend = [](const Eigen::Vector3d& x) { return Eigen::Vector3d(x.x(), x.y(), x.z() + 0.1 * x.x() * x.x()); };
  for (int i = 0; i < coarse.node_count(); ++i) coarse.nodes.col(i) = bend(coarse.nodes.col(i));
  const TetMesh fine = refine_mesh(coarse);
  for (int i = 0; i < fine.node_count(); ++i) {  // a quadratic map is exact on a quadratic mesh
    const Eigen::Vector3d x = fine.nodes.col(i);
    const double rest = x.z() - 0.1 * x.x() * x.x();
    EXPECT_NEAR(std::round(8.0 * rest), 8.0 * rest, 1e-12);
  }
}

TEST(Refine, KeepsRegionsWhateverShapeTheyHad) {
  for (const int order : {1, 2}) {
    const TetMesh coarse = make_box_mesh({0.1, 0.02, 0.02}, 4, 1, 1, order);
    const TetMesh fine = refine_mesh(coarse);
    const RegionSettings clamp{"clamp", BoxShape{{-1, -1, -1}, {1e-6, 1, 1}}};
    const RegionSettings near{"near", BoxShape{{-1, -1, -1}, {0.0500001, 1, 1}}};
    const auto regions = resolve_regions({clamp, near}, coarse), wanted = resolve_regions({clamp, near}, fine);
    const auto found = refine_regions(regions, coarse, fine);
    for (const std::string name : {"clamp", "near"}) {
      EXPECT_EQ(found.at(name).nodes, wanted.at(name).nodes) << name;
      EXPECT_EQ(found.at(name).facets, wanted.at(name).facets) << name;
      EXPECT_EQ(found.at(name).tets, wanted.at(name).tets) << name;
    }
  }
}

// What bulges out of a region's shape stays in the region.
TEST(Refine, ARegionIsThatOfTheMeshThatWasRefined) {
  for (const int order : {1, 2}) {
    TetMesh coarse = make_box_mesh({0.1, 0.1, 0.02}, 4, 4, 1, order);
    for (int i = 0; order == 2 && i < coarse.node_count(); ++i)
      coarse.nodes(0, i) += 1e-4 * std::cos(400.0 * M_PI * coarse.nodes(1, i));
    const TetMesh once = refine_mesh(coarse), twice = refine_mesh(once);
    const std::vector<RegionSettings> patch{{"patch", BoxShape{{-1, 0.0249, 0.0199}, {0.0502, 0.0751, 1}}},
                                            {"listed", VertexShape{{0, 1, 2, 5, 6, 7}}}};
    const auto regions = resolve_regions(patch, coarse);
    const auto of_once = resolve_regions(patch, once, 1), of_twice = resolve_regions(patch, twice, 2);
    for (const std::string name : {"patch", "listed"}) {
      const std::size_t facets = regions.at(name).facets.size();
      EXPECT_GT(facets, 0U) << name;
      EXPECT_EQ(of_once.at(name).facets.size(), 4 * facets) << name << ", order " << order;
      EXPECT_EQ(of_twice.at(name).facets.size(), 16 * facets) << name << ", order " << order;
      EXPECT_EQ(of_once.at(name).nodes, refine_regions(regions, coarse, once).at(name).nodes) << name;
    }
  }
}

TEST(Coarsen, TakesARefinementBack) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = make_box_mesh({0.1, 0.03, 0.02}, 3, 2, 1, order), back = coarsen_mesh(refine_mesh(mesh));
    EXPECT_EQ(back.corner_count, mesh.corner_count);
    EXPECT_EQ(back.nodes, mesh.nodes);
    EXPECT_EQ(back.tets, mesh.tets);
    EXPECT_EQ(back.facets, mesh.facets);
  }
}

TEST(Coarsen, RefusesAMeshThatWasNotRefined) {
  EXPECT_THROW(coarsen_mesh(make_box_mesh({0.1, 0.03, 0.02}, 1, 1, 1, 1)), InputError);  // six tetrahedra
  EXPECT_THROW(coarsen_mesh(make_box_mesh({0.1, 0.03, 0.02}, 4, 1, 1, 2)), InputError);
}

// A mesh of its own order holds a polynomial of that order; its children have to read the same one.
TEST(Refine, ProlongsWhatTheMeshHolds) {
  for (const int order : {1, 2}) {
    const TetMesh coarse = make_box_mesh({1.0, 1.0, 1.0}, 2, 3, 2, order);
    const TetMesh fine = refine_mesh(coarse);
    const auto held = [order](const TetMesh& mesh) {
      const Eigen::ArrayXd x = mesh.nodes.row(0), y = mesh.nodes.row(1), z = mesh.nodes.row(2);
      const Eigen::ArrayXd bent = x * x - 0.7 * x * y + 1.3 * y * z - z * z;
      return Eigen::VectorXd(1.0 + x - 2.0 * y + 3.0 * z + (order - 1) * bent);
    };
    const Eigen::VectorXd difference = prolongation(coarse, fine) * held(coarse) - held(fine);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-13) << "order " << order;
  }
}

TEST(BuildMesh, RefinesAsOftenAsTheModelAsks) {
  for (const int order : {1, 2}) {
    MeshSettings settings;
    settings.file = std::string(TISSUE_STIFFNESS_TEST_DATA) + "/meshing/box.vtk";
    settings.order = order;
    const TetMesh own = build_mesh(settings);
    settings.refine = 1;
    const TetMesh once = build_mesh(settings);
    EXPECT_EQ(once.tet_count(), 8 * own.tet_count());
    EXPECT_EQ(once.nodes.leftCols(own.node_count()), own.nodes);
    settings.refine = 2;
    const TetMesh twice = build_mesh(settings);
    EXPECT_EQ(twice.tet_count(), 64 * own.tet_count());
    EXPECT_EQ(twice.nodes.leftCols(once.node_count()), once.nodes);
    settings.refine = 12;
    try {
      build_mesh(settings);
      ADD_FAILURE() << "made 8^12 times as many tetrahedra";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("mesh.refine: found 12, which makes"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tissue_stiffness
