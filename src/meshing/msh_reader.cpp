#include <array>
#include <limits>
#include <vector>

#include "meshing/file_cursor.hpp"
#include "meshing/numbered_tets.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

constexpr long long kMaxCount = 100000000;
constexpr long long kMaxTag = std::numeric_limits<long long>::max() / 2;
constexpr int kTet = 4, kQuadraticTet = 11;

// Gmsh's second-order nodes lie on the edges 01, 12, 02, 03, 23, 13.
constexpr std::array<std::size_t, 10> kFromGmsh = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

// Returns the number of nodes of an element type that bounds a solid, and 0 for others. These types are points, lines,
// triangles, quadrangles, and their second-order variants.
int flat_size(long long type) {
  switch (type) {
    case 1:
      return 2;  // line
    case 2:
      return 3;  // triangle
    case 3:
      return 4;  // quadrangle
    case 8:
      return 3;  // second-order line
    case 9:
      return 6;  // second-order triangle
    case 10:
      return 9;  // second-order quadrangle
    case 15:
      return 1;  // point
    case 16:
      return 8;  // second-order quadrangle without centre
    default:
      return 0;
  }
}

class MshReader {
 public:
  explicit MshReader(const std::string& file) : in_(file) {}

  TetFile read() {
    while (!in_.at_end()) {
      const std::string section = in_.word();
      if (section == "$MeshFormat")
        read_format();
      else if (section == "$Nodes")
        version4_ ? read_nodes4() : read_nodes2();
      else if (section == "$Elements")
        version4_ ? read_elements4() : read_elements2();
      else
        skip(section);
    }
    if (!tets_.complete()) in_.fail("no nodes or no tetrahedra", "both");
    return tets_.assemble(
        [this](long long tag) { in_.fail("node " + std::to_string(tag) + " in a tetrahedron", "a node of $Nodes"); });
  }

 private:
  void skip(const std::string& section) {
    if (section.empty() || section[0] != '$') in_.fail("'" + section + "'", "a section that starts with $");
    const std::string end = "$End" + section.substr(1);
    while (in_.word() != end) continue;
  }

  void close(const std::string& end) {
    const std::string found = in_.word();
    if (found != end) in_.fail("'" + found + "'", end);
  }

  void read_format() {
    const std::string version = in_.word();
    if (version != "2.2" && version != "4.1") in_.fail("Gmsh format " + version, "2.2 or 4.1");
    version4_ = version == "4.1";
    if (in_.integer("file type", 0, 1) == 1) in_.fail("a binary file", "an ASCII .msh file");
    in_.word();
    close("$EndMeshFormat");
  }

  void read_point(long long tag) {
    const Eigen::Vector3d point = {in_.number("x"), in_.number("y"), in_.number("z")};
    if (!tets_.add_node(tag, point)) in_.fail("node " + std::to_string(tag) + " twice", "each node once");
  }

  void read_nodes2() {
    const long long count = in_.integer("node count", 1, kMaxCount);
    for (long long i = 0; i < count; ++i) {
      read_point(in_.integer("node number", 0, kMaxTag));
    }
    close("$EndNodes");
  }

  void read_nodes4() {
    const long long blocks = in_.integer("block count", 1, kMaxCount);
    in_.line();
    for (long long block = 0; block < blocks; ++block) {
      in_.integer("dimension", 0, 3);
      in_.integer("entity", -kMaxTag, kMaxTag);
      if (in_.integer("parametric", 0, 1) == 1) in_.fail("parametric coordinates", "a file saved without them");
      const long long count = in_.integer("node count", 0, kMaxCount);
      in_.require(count, 8, "nodes");  // a number, three coordinates, and their separators
      std::vector<long long> tags(static_cast<std::size_t>(count));
      for (long long& tag : tags) tag = in_.integer("node number", 0, kMaxTag);
      for (const long long tag : tags) read_point(tag);
    }
    close("$EndNodes");
  }

  void read_element(long long type) {
    if (const int size = flat_size(type)) {
      for (int i = 0; i < size; ++i) in_.word();
      return;
    }
    if (type != kTet && type != kQuadraticTet) {
      in_.fail("element type " + std::to_string(type), "tetrahedra: 4 (4 nodes) or 11 (10 nodes)");
    }
    std::array<long long, 10> nodes{};
    const std::size_t size = type == kTet ? 4 : 10;
    for (std::size_t i = 0; i < size; ++i) nodes[i] = in_.integer("node number", 0, kMaxTag);
    std::vector<long long>& list = type == kTet ? tets_.linear : tets_.quadratic;
    for (std::size_t i = 0; i < size; ++i) list.push_back(nodes[kFromGmsh[i]]);
  }

  void read_elements2() {
    const long long count = in_.integer("element count", 1, kMaxCount);
    for (long long i = 0; i < count; ++i) {
      in_.integer("element number", 0, kMaxTag);
      const long long type = in_.integer("element type", 1, 200);
      for (long long tags = in_.integer("tag count", 0, kMaxCount); tags > 0; --tags) in_.word();
      read_element(type);
    }
    close("$EndElements");
  }

  void read_elements4() {
    const long long blocks = in_.integer("block count", 1, kMaxCount);
    in_.line();
    for (long long block = 0; block < blocks; ++block) {
      in_.integer("dimension", 0, 3);
      in_.integer("entity", -kMaxTag, kMaxTag);
      const long long type = in_.integer("element type", 1, 200);
      for (long long count = in_.integer("element count", 0, kMaxCount); count > 0; --count) {
        in_.integer("element number", 0, kMaxTag);
        read_element(type);
      }
    }
    close("$EndElements");
  }

  FileCursor in_;
  bool version4_ = false;
  NumberedTets tets_;
};

}  // namespace

TetFile read_msh(const std::string& file) {
  return MshReader(file).read();
}

}  // namespace tissue_stiffness
