#include <algorithm>
#include <set>
#include <unordered_set>

#include "meshing/inp_lines.hpp"
#include "meshing/numbered_tets.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

// Keywords that make, move or rename nodes and elements. A mesh that is read without them would be another one.
const std::set<std::string> kUnread = {"ELCOPY", "ELGEN", "IMPORT", "INCLUDE", "NCOPY", "NFILL", "NGEN", "NMAP", "SYSTEM"};

// Elements that bound a solid: bars, beams, plane ones, shells and membranes, and rigid ones.
const std::set<std::string> kFlat = {"B2", "B3", "CAX", "CPE", "CPS", "M3D", "R2D", "R3D", "S3",
                                     "S4", "S6", "S8",  "S9",  "SAX", "SFM", "STR", "T2D", "T3D"};

bool is_flat(const std::string& type) {
  return kFlat.count(type.substr(0, 2)) + kFlat.count(type.substr(0, 3)) > 0;
}

// Returns the number of nodes of a tetrahedron, and 0 for another type. The letters behind the number choose the
// interpolation of the stress.
std::size_t nodes_of(const std::string& type) {
  for (const auto& [start, count] : {std::pair<std::string, std::size_t>{"C3D10", 10}, {"C3D4", 4}}) {
    if (type.rfind(start, 0) != 0) continue;
    const auto letters = type.begin() + static_cast<std::ptrdiff_t>(start.size());
    return std::all_of(letters, type.end(), [](char c) { return c >= 'A' && c <= 'Z'; }) ? count : 0;
  }
  return 0;
}

class InpReader {
 public:
  explicit InpReader(const std::string& file) : in_(file) {}

  TetFile read() {
    while (!in_.at_end()) read_block();
    if (!tets_.complete()) in_.fail("no nodes or no tetrahedra", "*NODE and *ELEMENT with TYPE=C3D4 or C3D10");
    return tets_.assemble([this](long long number) {
      in_.fail("node " + std::to_string(number) + " in a tetrahedron, which is not in the file", "a node of *NODE");
    });
  }

 private:
  void read_block() {
    const InpKeyword key = in_.keyword();
    const bool here = key.name == "NODE" || key.name == "ELEMENT";
    if (here && key.values.count("INPUT") > 0) in_.fail("*" + key.name + " with INPUT", "data in this file");
    if (kUnread.count(key.name) > 0) in_.fail("*" + key.name, "*NODE and *ELEMENT that hold the whole mesh");
    if (key.name == "PART" || key.name == "INSTANCE") {
      read_part(key.name);
    } else if (key.name == "NODE") {
      read_nodes(key);
    } else if (key.name == "ELEMENT") {
      read_elements(key);
    } else {
      in_.skip_data();
    }
  }

  // The numbers of a second part begin anew, and an instance's data lines move it.
  void read_part(const std::string& name) {
    if (!parts_.insert(name).second) in_.fail("a second *" + name, "one body in a file");
    if (in_.skip_data() > 0) in_.fail("*" + name + " with data, which move it", "a part at its own coordinates");
  }

  void read_nodes(const InpKeyword& key) {
    const auto system = key.values.find("SYSTEM");
    if (system != key.values.end() && system->second != "R") {
      in_.fail("*NODE with SYSTEM=" + system->second, "rectangular coordinates (SYSTEM=R)");
    }
    while (!in_.at_end() && !in_.at_keyword()) {
      const std::vector<std::string> fields = in_.entry(4, "number, x, y, z");
      const long long number = in_.number_of(fields[0], "node number");
      const Eigen::Vector3d point = {in_.coordinate_of(fields[1], "x"), in_.coordinate_of(fields[2], "y"),
                                     in_.coordinate_of(fields[3], "z")};
      if (!tets_.add_node(number, point)) in_.fail("node " + std::to_string(number) + " twice", "each node once");
    }
  }

  void read_elements(const InpKeyword& key) {
    const auto found = key.values.find("TYPE");
    const std::string type = found == key.values.end() ? "" : found->second;
    if (is_flat(type)) {
      in_.skip_data();
      return;
    }
    const std::size_t size = nodes_of(type);
    if (size == 0) in_.fail("*ELEMENT with TYPE=" + type, "tetrahedra: C3D4 or C3D10");
    std::vector<long long>& list = size == 4 ? tets_.linear : tets_.quadratic;
    while (!in_.at_end() && !in_.at_keyword()) {
      const std::vector<std::string> fields = in_.entry(1 + size, "number and nodes of " + type);
      const long long number = in_.number_of(fields[0], "element number");
      if (!elements_.insert(number).second) {
        in_.fail("element " + std::to_string(number) + " twice", "each element once");
      }
      for (std::size_t i = 1; i <= size; ++i) list.push_back(in_.number_of(fields[i], "node number"));
    }
  }

  InpLines in_;
  NumberedTets tets_;
  std::unordered_set<long long> elements_;
  std::set<std::string> parts_;
};

}  // namespace

TetFile read_inp(const std::string& file) {
  return InpReader(file).read();
}

}  // namespace tissue_stiffness
