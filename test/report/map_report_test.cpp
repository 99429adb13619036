// The map of the stiffness in what a run writes.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "example.hpp"
#include "report/map_vtk.hpp"
#include "report/page.hpp"
#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

/// Two patches on two tetrahedra, the second at its prior.
StiffnessMap example_map() {
  StiffnessMap map;
  map.levels = {{1, 4.0, 0.0, true}, {2, 1.1, 250.0, true}};
  map.patches = {{{0.1, 0.2, 0.3}, 30e3, 0.01, 29e3, 31e3, true}, {{0.4, 0.5, 0.6}, 50e3, 0.7, 12e3, 2e5, false}};
  map.patch_of_tet = {1, 0, -1};
  return map;
}

TEST(ResultsJson, HoldsTheMapWhereThereIsOne) {
  Results results = example(20);
  EXPECT_FALSE(json::parse(results_json(results)).contains("map"));
  results.map = example_map();
  const json map = json::parse(results_json(results))["map"];
  EXPECT_EQ(map["levels"][1]["patches"], 2);
  EXPECT_EQ(map["levels"][1]["log_evidence"], 250.0);
  EXPECT_EQ(map["patches"][0]["center"], json({0.1, 0.2, 0.3}));
  EXPECT_EQ(map["patches"][0]["young_modulus"], 30e3);
  EXPECT_EQ(map["patches"][1]["interval95"], json({12e3, 2e5}));
  EXPECT_EQ(map["patches"][1]["identified"], false);
  EXPECT_EQ(map["identified"], 1);
  EXPECT_EQ(map["mesh_error"], "assessed");
}

TEST(ReportHtml, SaysHowMuchOfTheBodyTheMapIdentifies) {
  Results results = example(20);
  EXPECT_EQ(report_html(results, {}).find("id=\"map\""), std::string::npos);
  results.map = example_map();
  const std::string page = report_html(results, {});
  EXPECT_NE(page.find("1 of the body&#39;s 2 parts are identified; of the others"), std::string::npos);
  EXPECT_NE(page.find("at its prior</span>"), std::string::npos);
  EXPECT_NE(page.find("and the error of the mesh."), std::string::npos);
  results.map->mesh_error = "the mesh has more than 17000 nodes";
  EXPECT_NE(report_html(results, {}).find("not the error of the mesh: the mesh has more"), std::string::npos);
  results.map->misfit = 3.04;
  EXPECT_NE(report_html(results, {}).find("the map leaves an error of 3.0 times the noise"), std::string::npos);
  EXPECT_NE(report_html(results, {}).find("not to be used</span>"), std::string::npos);
}

TEST(MapVtk, HoldsTheBodyAndItsPatches) {
  TetMesh mesh;
  mesh.nodes = Eigen::Matrix3Xd::Zero(3, 7);
  mesh.nodes.row(1) << 0, 1, 2, 3, 4, 5, 6.25;
  mesh.tets.resize(4, 3);
  mesh.tets << 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5;
  const std::string whole = map_vtk(example_map(), mesh);
  const auto holds = [&](const std::string& text) { return whole.find(text) != std::string::npos; };
  EXPECT_TRUE(holds("POINTS 7 double\n0 0 0\n0 1 0\n"));
  EXPECT_TRUE(holds("\n0 6.25 0\nCELLS 3 15\n4 0 1 2 3\n"));
  EXPECT_TRUE(holds("CELL_TYPES 3\n10\n10\n10\nCELL_DATA 3\n"));
  EXPECT_TRUE(holds("SCALARS patch int 1\nLOOKUP_TABLE default\n1\n0\n-1\n"));
  EXPECT_TRUE(holds("SCALARS young_modulus double 1\nLOOKUP_TABLE default\n50000\n30000\n0\n"));
  EXPECT_TRUE(holds("SCALARS identified int 1\nLOOKUP_TABLE default\n0\n1\n0\n"));
}

TEST(MapVtk, GivesBackThePatches) {
  TetMesh mesh;
  mesh.nodes = Eigen::Matrix3Xd::Zero(3, 6);
  mesh.tets = Eigen::MatrixXi::Zero(4, 3);
  const std::string file = (std::filesystem::temp_directory_path() / "tissue_stiffness_map.vtk").string();
  const std::string text = map_vtk(example_map(), mesh);
  write_text(file, text);
  EXPECT_EQ(read_map_patches(file), (std::vector<int>{1, 0, -1}));
  for (const std::string& broken : {std::string("CELL_DATA"), text.substr(0, text.find("patch") + 36)}) {
    write_text(file, broken);
    EXPECT_THROW(read_map_patches(file), InputError) << broken;
  }
  std::filesystem::remove(file);
  EXPECT_THROW(read_map_patches(file), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
