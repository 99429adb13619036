// VTK's XML unstructured grids, read by VTK in another process.
#include "vtu/vtu_reader.hpp"

#include <utility>
#include <vector>

#include "../meshing/mesh_checks.hpp"
#include "../written_file.hpp"
#include "meshing/tet_file_check.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

std::string array(const std::string& name, const std::string& type, const std::string& values) {
  return "<DataArray Name=\"" + name + "\" type=\"" + type + "\" format=\"ascii\">" + values + "</DataArray>\n";
}

/// A tetrahedron beside a triangle.
std::string grid() {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
         "<UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n<Points>\n"
         "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>\n"
         "</Points>\n<Cells>\n" +
         array("connectivity", "Int64", "0 1 2 0 1 2 3") + array("offsets", "Int64", "3 7") +
         array("types", "UInt8", "5 10") + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = grid();
  return text.replace(text.find(from), from.size(), to);
}

TEST(VtuReader, ReadsTetrahedraAndSkipsWhatBoundsThem) {
  const WrittenFile file(".vtu", grid());
  const TetFile found = read_vtu(file.name);
  EXPECT_EQ(found.tets, Eigen::Vector4i(0, 1, 2, 3));
  EXPECT_EQ(found.nodes.rightCols(3), Eigen::Matrix3d::Identity());
}

/// The same box as in test/meshing, in base 64 and compressed, and as bytes behind the XML.
TEST(VtuReader, ReadsEveryEncoding) {
  for (const std::string name : {"box", "box_10_node"}) {
    const TetFile found = read_vtu(mesh_file(name + ".vtu")), expected = read_vtk(mesh_file(name + ".vtk"));
    EXPECT_EQ(found.nodes, expected.nodes);
    EXPECT_EQ(found.tets, expected.tets);
  }
}

TEST(VtuReader, IsForProgramsThatAskForIt) {
  const WrittenFile file(".vtu", grid());
  expect_contains(refusal([&] { load_tet_mesh(file.name, 0.1, 1); }), "ending '.vtu'; allowed: .ele, .inp");
  accept_vtu_meshes();
  expect_sound(load_tet_mesh(file.name, 0.1, 2), 1e-3 / 6.0, 1e-15);
}

TEST(VtuReader, LeavesItToTheMeshsChecksThatThereAreTetrahedra) {
  for (const std::string& text : {with("NumberOfCells=\"2\"", "NumberOfCells=\"0\""), with("5 10", "5 9")}) {
    const WrittenFile file(".vtu", text);
    EXPECT_EQ(read_vtu(file.name).tets.cols(), 0);
    expect_contains(refusal([&] { check_tet_file(read_vtu(file.name), 1.0, 1, file.name); }), "no tetrahedra");
  }
}

TEST(VtuReader, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {with("</Points>", "</Point>"), "line 7, column "},
      {with("\"4\"", "\"60000000\""), "points array"},
      {with("\"4\"", "\"-4\""), "points array"},
      {with("0 0 0 1", "0 x 0 1"), "points array"},
      {with("3 7", "3 700"), "\"connectivity\" array is not long enough"},
      {with("3 7", "3 2"), "array"},
      {with("0 1 2 3", "0 1 2 9"), "node 9 in cell 1; allowed: 0 to 3"},
      {with("0 1 2 3", "0 1 2 -3"), "node -3 in cell 1; allowed: 0 to 3"},
      {with("5 10", "5 12"), "cell 1 of type 12 with 4 nodes; allowed: tetrahedra"},
      {with("5 10", "5 24"), "cell 1 of type 24 with 4 nodes"},
      {with("3 7", "4 7"), "cell 1 of type 10 with 3 nodes"},
      {"# vtk DataFile Version 3.0\n", "line 1"},
      {"", "an empty file"}};
  for (const auto& [text, part] : refused) {
    const WrittenFile file(".vtu", text);
    const std::string message = refusal([&] { read_vtu(file.name); });
    expect_contains(message, "mesh file " + file.name + ": found ");
    expect_contains(message, part);
    EXPECT_EQ(message.find("0x"), std::string::npos) << message;
  }
  expect_contains(refusal([] { read_vtu("no_such_file.vtu"); }), "no readable file");
}

}  // namespace
}  // namespace tissue_stiffness
