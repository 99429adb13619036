#include <cstdio>
#include <utility>
#include <vector>

#include "../written_file.hpp"
#include "mesh_checks.hpp"
#include "meshing/box_mesh.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

TetMesh load(const std::string& name, int order = 2) {
  return load_tet_mesh(mesh_file(name), 0.01, order);
}

// All files hold the same box of 2 x 1 x 1 (times the scale), in the numbering of make_box_mesh.
class TetFiles : public testing::TestWithParam<std::string> {};

TEST_P(TetFiles, HoldTheBox) {
  for (const int order : {1, 2}) {
    const TetMesh expected = make_box_mesh({0.02, 0.01, 0.01}, 2, 1, 1, order);
    const TetMesh mesh = load(GetParam(), order);
    expect_sound(mesh, 2e-6, 1e-18);
    EXPECT_EQ(mesh.corner_count, expected.corner_count);
    EXPECT_TRUE(mesh.nodes.leftCols(mesh.corner_count).isApprox(expected.nodes.leftCols(mesh.corner_count)));
    EXPECT_EQ(mesh.tets, expected.tets);
    EXPECT_EQ(mesh.facets, expected.facets);
    EXPECT_EQ(mesh.facet_tet, expected.facet_tet);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, TetFiles,
                         testing::Values("box.vtk", "box_10_node.vtk", "box_binary.vtk", "box_binary_5_1.vtk",
                                         "box_from_0.node", "box_from_0.ele", "box_from_1.node", "box_2_2.msh",
                                         "box_4_1.msh", "box.inp", "box_10_node.inp"));

TEST(TetFileChecks, AFileThatInvertsAllIsReordered) {
  expect_sound(load("box_all_inverted.vtk"), 2e-6, 1e-18);
}

struct Refused {
  std::string file, part;
};
class RefusedTetFiles : public testing::TestWithParam<Refused> {};

TEST_P(RefusedTetFiles, NameFileAndPlace) {
  const std::string message = refusal([] { load(GetParam().file); });
  expect_contains(message, GetParam().file);
  expect_contains(message, GetParam().part);
}

INSTANTIATE_TEST_SUITE_P(
    Bad, RefusedTetFiles,
    testing::Values(Refused{"box_one_inverted.vtk", "tetrahedron 7 at (0.0125, 0.0075, 0.005) m, which is inverted"},
                    Refused{"box_unused_vertex.vtk", "vertex 12 at (0.05, 0.05, 0.05) m in no tetrahedron"},
                    Refused{"box_nan.vtk", "vertex 0 with a coordinate that is not finite"},
                    Refused{"box_coincident.vtk", "both at (0.01, "}, Refused{"box_hexahedron.vtk", "type 12 with 8 nodes"},
                    Refused{"box_node_out_of_range.vtk", "node 99"}, Refused{"box_truncated.vtk", "entries (cells)"},
                    Refused{"no_such_file.vtk", "no readable file"}, Refused{"cube.obj", "ending '.obj'"}));

std::string vtk_tetrahedron(const std::string& points, const std::string& offsets) {
  return "# vtk DataFile Version 5.1\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\n" + points + "\nCELLS 2 4\nOFFSETS int\n" +
         offsets + "\nCONNECTIVITY int\n0 1 2 3\nCELL_TYPES 1\n10\n";
}

TEST(TetFileChecks, CellOffsetsStayInTheirList) {
  const std::string points = "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1";
  EXPECT_EQ(load_tet_mesh(WrittenFile(".vtk", vtk_tetrahedron(points, "0 4")).name, 1.0, 1).tet_count(), 1);
  for (const std::string offsets : {"0 400", "1 5", "4 0", "0 3"}) {
    const WrittenFile file(".vtk", vtk_tetrahedron(points, offsets));
    expect_contains(refusal([&] { load_tet_mesh(file.name, 1.0, 1); }), "cell offsets");
  }
}

TEST(TetFileChecks, CountsThatTheFileCannotHoldCostNoMemory) {
  const std::vector<std::pair<std::string, std::string>> files{
      {".vtk", vtk_tetrahedron("POINTS 60000000 double\n0 0 0", "0 4")},
      {".msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 90000000 1 90000000\n3 1 0 90000000\n1 2\n"},
      {".node", "90000000 3 0 0\n1 0 0 0\n"}};
  for (const auto& [ending, text] : files) {
    const WrittenFile file(ending, text);
    expect_contains(refusal([&] { load_tet_mesh(file.name, 1.0, 1); }), "0000000 entries");
  }
}

std::string inp_tetrahedron(const std::string& more, const std::string& element = "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n") {
  return "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n" + element + more;
}

TEST(InpFiles, SkipWhatIsNoMesh) {
  for (const std::string more : {"", "*MATERIAL, NAME=A\n*ELASTIC\n1e3, 0.4\n", "*NSET, NSET=A, GENERATE\n1, 4, 1\n",
                                 "*ELEMENT, TYPE=S3R\n2, 1, 2, 3\n", "*ELEMENT OUTPUT\nS\n", "*NODE\n9, 5, 5, 5"}) {
    const WrittenFile file(".inp", inp_tetrahedron(more));
    EXPECT_EQ(load_tet_mesh(file.name, 1.0, 1).node_count(), 4) << more;
  }
}

TEST(InpFiles, HaveFourNodesWhereTheyHaveTetrahedraOfBothOrders) {
  std::string nodes = "*NODE\n5, 1, 1, 1\n", edges;
  for (int k = 11; k <= 16; ++k) {
    nodes += std::to_string(k) + ", 0.5, 0.5, 0.5\n";
    edges += ", " + std::to_string(k);
  }
  const WrittenFile file(".inp", inp_tetrahedron(nodes + "*ELEMENT, TYPE=C3D10\n2, 2, 3, 4, 5" + edges + "\n"));
  const TetMesh mesh = load_tet_mesh(file.name, 1.0, 1);
  EXPECT_EQ(mesh.tet_count(), 2);
  EXPECT_EQ(mesh.node_count(), 5);
}

TEST(InpFiles, NameLineValueAndWhatIsAllowed) {
  const std::string nodes = inp_tetrahedron("", "");  // five lines
  const std::vector<std::pair<std::string, std::string>> refused{
      {inp_tetrahedron("*ELEMENT, TYPE=C3D8\n2, 1, 2, 3, 4, 1, 2, 3, 4\n"), ":8: found *ELEMENT with TYPE=C3D8"},
      {inp_tetrahedron("*ELEMENT, TYPE=C3D40\n"), "TYPE=C3D40; allowed: tetrahedra: C3D4 or C3D10"},
      {inp_tetrahedron("*ELEMENT, TYPE=SC6R\n"), "TYPE=SC6R"},
      {inp_tetrahedron("*ELEMENT, ELSET=A\n"), "*ELEMENT with TYPE="},
      {inp_tetrahedron("*INCLUDE, INPUT=more.inp\n"), ":8: found *INCLUDE"},
      {inp_tetrahedron("*NGEN\n1, 4\n"), "*NGEN; allowed: *NODE and *ELEMENT that hold the whole mesh"},
      {inp_tetrahedron("*node, input=nodes.txt\n"), "*NODE with INPUT; allowed: data in this file"},
      {inp_tetrahedron("*NODE, SYSTEM=C\n"), "SYSTEM=C; allowed: rectangular"},
      {inp_tetrahedron("*NODE\n2, 1, 0, 0\n"), ":9: found node 2 twice"},
      {inp_tetrahedron("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"), ":9: found element 1 twice"},
      {inp_tetrahedron("*NODE\n** a comment\n\n7, 1, zero, 0\n"), ":11: found 'zero'; allowed: a number (y)"},
      {inp_tetrahedron("*NODE\n7, 1, , 0\n"), "found ''; allowed: a number (y)"},
      {inp_tetrahedron("*NODE\n0, 1, 0, 0\n"), "found '0'; allowed: a whole number from 1 (node number)"},
      {inp_tetrahedron("*NODE\n7, 1, 0\n"), "found 3 numbers; allowed: 4 numbers"},
      {inp_tetrahedron("*NODE\n7, 1, 0, 0, 1\n"), "found 5 numbers; allowed: 4 numbers"},
      {inp_tetrahedron("*PART, NAME=A\n*PART, NAME=B\n"), ":9: found a second *PART"},
      {inp_tetrahedron("*INSTANCE, NAME=A, PART=B\n0, 0, 1\n"), "*INSTANCE with data"},
      {inp_tetrahedron("", "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 9\n"), "node 9 in a tetrahedron"},
      {inp_tetrahedron("", "*ELEMENT, TYPE=C3D10\n1, 1, 2, 3, 4\n"), "found 5 numbers; allowed: 11 numbers"},
      {nodes, "no nodes or no tetrahedra"},
      {"8 5 0 0 0\n", ":1: found '8 5 0 0 0'; allowed: a keyword that begins with *"},
      {"", "no nodes or no tetrahedra"}};
  for (const auto& [text, part] : refused) {
    const WrittenFile file(".inp", text);
    expect_contains(refusal([&] { load_tet_mesh(file.name, 1.0, 2); }), part);
    expect_contains(refusal([&] { load_tet_mesh(file.name, 1.0, 2); }), file.name + ":");
  }
}

TEST(TetReaders, MayBeAdded) {
  EXPECT_FALSE(is_tet_file("box.abc"));
  expect_contains(refusal([] { load_tet_mesh("box.abc", 1.0, 1); }), ".ele, .inp, .msh, .node, .vtk");
  add_tet_reader(".abc", [](const std::string&) { return read_vtk(mesh_file("box.vtk")); });
  EXPECT_TRUE(is_tet_file("box.ABC"));
  EXPECT_EQ(load_tet_mesh("box.abc", 1.0, 1).tets, load_tet_mesh(mesh_file("box.vtk"), 1.0, 1).tets);
}

TEST(TetFileChecks, ABodyIsNeitherTooSmallNorTooLarge) {
  expect_contains(refusal([] { load_tet_mesh(mesh_file("box.vtk"), 1e30, 2); }), "is the scale right?");
  expect_contains(refusal([] { load_tet_mesh(mesh_file("box.vtk"), 1e-30, 2); }), "longest side is 2e-30 m");
  const WrittenFile file(".vtk", vtk_tetrahedron("POINTS 4 double\n0 0 0 1e308 0 0 0 1 0 0 0 1", "0 4"));
  expect_contains(refusal([&] { load_tet_mesh(file.name, 1.0, 1); }), "vertex 1 with a coordinate of 1e+308 m");
}

TEST(SaveMesh, ReadsBackBitForBit) {
  for (const int order : {1, 2}) {
    TetMesh mesh = make_box_mesh({0.1, 0.2, 0.3}, 2, 3, 1, order, {1.0 / 3.0, -2.0 / 7.0, 1e-9});
    if (order == 2) mesh.nodes.col(mesh.corner_count + 3) += Eigen::Vector3d(1e-3, 1.0 / 3e3, 0.0);  // a curved edge
    const std::string file = testing::TempDir() + "saved_mesh.vtk";
    save_mesh(mesh, file);
    const TetMesh again = load_tet_mesh(file, 1.0, order);
    EXPECT_EQ(again.nodes, mesh.nodes);
    EXPECT_EQ(again.tets, mesh.tets);
    EXPECT_EQ(again.facets, mesh.facets);
    EXPECT_EQ(again.corner_count, mesh.corner_count);
    std::remove(file.c_str());
  }
}

TEST(SaveMesh, SaysWhatItCannotWrite) {
  const TetMesh mesh = make_box_mesh({1.0, 1.0, 1.0}, 1, 1, 1);
  expect_contains(refusal([&] { save_mesh(mesh, "mesh.stl"); }), ".vtk");
  expect_contains(refusal([&] { save_mesh(mesh, "/no/such/folder/mesh.vtk"); }), "/no/such/folder/mesh.vtk");
}

TEST(Regions, TakeTheirClosedBounds) {
  const TetMesh mesh = make_box_mesh({2.0, 1.0, 1.0}, 2, 1, 1, 2);
  const auto regions = resolve_regions({{"face", BoxShape{{0, 0, 0}, {0, 1, 1}}},
                                        {"half", HalfSpaceShape{{1, 0, 0}, {1, 0, 0}}},
                                        {"ball", SphereShape{{0, 0, 0}, 1.0}},
                                        {"egg", EllipsoidShape{{1, 0.5, 0.5}, {10, 10, 10}}},
                                        {"edge", VertexShape{{0, 3, 9}}}},
                                       mesh);
  EXPECT_EQ(regions.at("face").nodes.size(), 9u);
  EXPECT_EQ(regions.at("face").facets.size(), 2u);
  EXPECT_TRUE(regions.at("face").tets.empty());
  EXPECT_EQ(regions.at("half").tets.size(), 6u);
  EXPECT_EQ(regions.at("half").facets.size(), 10u);
  EXPECT_EQ(regions.at("egg").nodes.size(), static_cast<std::size_t>(mesh.node_count()));
  EXPECT_EQ(regions.at("egg").facets.size(), static_cast<std::size_t>(mesh.facet_count()));
  for (const int node : regions.at("ball").nodes) EXPECT_LE(mesh.nodes.col(node).norm(), 1.0);
  EXPECT_EQ(regions.at("edge").facets.size(), 1u);
  EXPECT_EQ(regions.at("edge").nodes.size(), 6u) << "three corners and the mid nodes between them";
}

TEST(Regions, RefuseWhatIsNotThere) {
  const TetMesh mesh = make_box_mesh({2.0, 1.0, 1.0}, 2, 1, 1, 1);
  expect_contains(refusal([&] { resolve_regions({{"tip", SphereShape{{9, 9, 9}, 1.0}}}, mesh); }), "regions.tip");
  expect_contains(refusal([&] { resolve_regions({{"list", VertexShape{{3, 12}}}}, mesh); }), "found 12; allowed: 0 to 11");
}

}  // namespace
}  // namespace tissue_stiffness
