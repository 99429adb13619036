#include "report/map_vtk.hpp"

#include <functional>
#include <sstream>

#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kTetra = 10, kQuadraticTetra = 24;  // VTK's cell types; their node order is TetMesh's
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30U;

}  // namespace

std::string map_vtk(const StiffnessMap& map, const TetMesh& mesh) {
  std::ostringstream out;
  out.precision(9);
  const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols);
  out << "# vtk DataFile Version 3.0\nYoung's modulus [Pa]\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  out << "POINTS " << mesh.node_count() << " double\n";
  for (int i = 0; i < mesh.node_count(); ++i) out << mesh.nodes.col(i).transpose().format(row) << "\n";
  const Eigen::Index size = mesh.tets.rows();
  out << "CELLS " << mesh.tet_count() << " " << (size + 1) * mesh.tet_count() << "\n";
  for (int tet = 0; tet < mesh.tet_count(); ++tet) out << size << " " << mesh.tets.col(tet).transpose().format(row) << "\n";
  out << "CELL_TYPES " << mesh.tet_count() << "\n";
  for (int tet = 0; tet < mesh.tet_count(); ++tet) out << (mesh.quadratic() ? kQuadraticTetra : kTetra) << "\n";
  out << "CELL_DATA " << mesh.tet_count() << "\nSCALARS patch int 1\nLOOKUP_TABLE default\n";
  for (const int patch : map.patch_of_tet) out << patch << "\n";
  const auto write = [&](const std::string& declaration, const std::function<double(const StiffnessPatch&)>& value) {
    out << "SCALARS " << declaration << " 1\nLOOKUP_TABLE default\n";
    for (const int patch : map.patch_of_tet) {
      out << (patch < 0 ? 0.0 : value(map.patches[static_cast<std::size_t>(patch)])) << "\n";
    }
  };
  write("young_modulus double", [](const StiffnessPatch& patch) { return patch.young_modulus; });
  write("lower95 double", [](const StiffnessPatch& patch) { return patch.lower95; });
  write("upper95 double", [](const StiffnessPatch& patch) { return patch.upper95; });
  write("identified int", [](const StiffnessPatch& patch) { return patch.identified ? 1.0 : 0.0; });
  return out.str();
}

std::vector<int> read_map_patches(const std::string& file) {
  const std::string allowed = "the map.vtk that `estimate` wrote";
  std::istringstream in(read_file(file, file, allowed, kLargestFile));
  std::string word;
  std::size_t count = 0;
  while (in >> word && word != "CELL_DATA") {
  }
  if (!(in >> count)) throw InputError(file, "no CELL_DATA", allowed);
  while (in >> word && word != "patch") {
  }
  std::vector<int> out;
  for (int i = 0; i < 4 && in >> word; ++i) {  // "int 1 LOOKUP_TABLE default"
  }
  for (int patch = 0; out.size() < count && in >> patch;) out.push_back(patch);
  if (out.size() != count) {
    throw InputError(file, std::to_string(out.size()) + " numbers of `patch`",
                     std::to_string(count) + ", one a tetrahedron");
  }
  return out;
}

}  // namespace tissue_stiffness
