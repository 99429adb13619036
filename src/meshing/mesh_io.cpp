#include "tissue_stiffness/meshing/mesh_io.hpp"

#include <algorithm>
#include <cctype>
#include <iomanip>
#include <limits>
#include <map>
#include <mutex>
#include <ostream>

#include "meshing/file_ending.hpp"
#include "meshing/tet_file_check.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/pending_file.hpp"

namespace tissue_stiffness {
namespace {

struct Readers {
  std::mutex mutex;
  std::map<std::string, TetReader> by_ending = {
      {".ele", read_node_ele}, {".inp", read_inp}, {".msh", read_msh}, {".node", read_node_ele}, {".vtk", read_vtk}};
};

Readers& readers() {
  static Readers all;
  return all;
}

// Returns nothing callable for an unknown ending.
TetReader reader_of(const std::string& ending) {
  const std::lock_guard<std::mutex> lock(readers().mutex);
  const auto found = readers().by_ending.find(ending);
  return found == readers().by_ending.end() ? TetReader() : found->second;
}

void write_vtk(const TetMesh& mesh, std::ostream& out) {
  out << "# vtk DataFile Version 3.0\ntissue_stiffness mesh, m\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  out << "POINTS " << mesh.node_count() << " double\n" << std::setprecision(std::numeric_limits<double>::max_digits10);
  for (int i = 0; i < mesh.node_count(); ++i) {
    out << mesh.nodes(0, i) << ' ' << mesh.nodes(1, i) << ' ' << mesh.nodes(2, i) << '\n';
  }
  const Eigen::Index size = mesh.tets.rows();
  out << "CELLS " << mesh.tet_count() << ' ' << mesh.tet_count() * (size + 1) << '\n';
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    out << size;
    for (Eigen::Index i = 0; i < size; ++i) out << ' ' << mesh.tets(i, tet);
    out << '\n';
  }
  out << "CELL_TYPES " << mesh.tet_count() << '\n';
  for (int tet = 0; tet < mesh.tet_count(); ++tet) out << (mesh.quadratic() ? "24\n" : "10\n");
}

}  // namespace

std::string file_ending(const std::string& file) {
  const std::size_t dot = file.rfind('.');
  if (dot == std::string::npos || file.find('/', dot) != std::string::npos) return "";
  std::string ending = file.substr(dot);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool is_tet_file(const std::string& file) {
  return reader_of(file_ending(file)) != nullptr;
}

std::string tet_endings() {
  const std::lock_guard<std::mutex> lock(readers().mutex);
  std::string out;
  for (const auto& [ending, reader] : readers().by_ending) out += (out.empty() ? "" : ", ") + ending;
  return out;
}

void add_tet_reader(const std::string& ending, const TetReader& reader) {
  const std::lock_guard<std::mutex> lock(readers().mutex);
  readers().by_ending[ending] = reader;
}

TetMesh load_tet_mesh(const std::string& file, double scale, int order) {
  const std::string where = "mesh file " + file, ending = file_ending(file);
  const TetReader reader = reader_of(ending);
  if (!reader) throw InputError(where, "ending '" + ending + "'", tet_endings());
  return check_tet_file(reader(file), scale, order, where);
}

void save_mesh(const TetMesh& mesh, const std::string& file) {
  if (file_ending(file) != ".vtk") throw InputError("mesh file " + file, "another ending", ".vtk");
  write_file(file, [&mesh](std::ostream& out) { write_vtk(mesh, out); });
}

}  // namespace tissue_stiffness
