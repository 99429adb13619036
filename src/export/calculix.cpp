// CalculiX's input file. Its C3D4 and C3D10 have the nodes and quadrature points of TetMesh and Discretisation.
#include <sstream>

#include "export/formats.hpp"
#include "export/material_groups.hpp"
#include "fem/neo_hookean.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kDigits = 12;                       // a field has 20 characters at most
constexpr std::size_t kPerLine = 16;              // numbers
constexpr std::size_t kLongest = 120;             // characters of a comment
const char* const kIncrements = "0.1, 1., 1e-5";  // of a step with finite strain: the first one, the end, the least one

std::vector<std::string> remarks_of(const ExportedModel& model) {
  std::vector<std::string> out = model.remarks;
  if (model.finite_strain) {
    out.emplace_back("CalculiX's neo-Hookean law has another volumetric part; both agree for small strain");
  }
  if (model.mass_damping > 0.0 || model.stiffness_damping > 0.0) {
    out.emplace_back("the damping has no effect in a static step; it is there for a *DYNAMIC one");
  }
  return out;
}

// Breaks a comment between words.
void write_comment(const std::string& text, std::ostream& out) {
  std::istringstream words(text);
  std::string line = "**";
  for (std::string word; words >> word;) {
    if (line.size() + word.size() > kLongest && line.size() > 2) {
      out << line << "\n";
      line = "**  ";
    }
    line += " " + word;
  }
  out << line << "\n";
}

// Writes numbers from 1.
void write_list(const std::vector<int>& numbers, std::ostream& out) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    out << numbers[i] + 1 << ((i + 1) % kPerLine == 0 || i + 1 == numbers.size() ? "\n" : ", ");
  }
}

void write_mesh(const TetMesh& mesh, std::ostream& out) {
  out << "*NODE, NSET=ALL\n";
  for (int i = 0; i < mesh.node_count(); ++i) {
    out << i + 1 << ", " << mesh.nodes(0, i) << ", " << mesh.nodes(1, i) << ", " << mesh.nodes(2, i) << "\n";
  }
  out << "*ELEMENT, TYPE=" << (mesh.quadratic() ? "C3D10" : "C3D4") << ", ELSET=BODY\n";
  for (int e = 0; e < mesh.tet_count(); ++e) {
    out << e + 1;
    for (Eigen::Index i = 0; i < mesh.tets.rows(); ++i) out << ", " << mesh.tets(i, e) + 1;
    out << "\n";
  }
}

void write_material(const ExportedModel& model, const MaterialGroup& group, const std::string& name, std::ostream& out) {
  out << "*ELSET, ELSET=" << name << "\n";
  write_list(group.tets, out);
  out << "*MATERIAL, NAME=" << name << "\n";
  if (model.finite_strain) {
    const Lame moduli = lame(group.young_modulus, group.poisson_ratio);
    const double bulk = moduli.lambda + 2.0 / 3.0 * moduli.mu;
    out << "*HYPERELASTIC, NEO HOOKE\n" << 0.5 * moduli.mu << ", " << 2.0 / bulk << "\n";
  } else {
    out << "*ELASTIC\n" << group.young_modulus << ", " << group.poisson_ratio << "\n";
  }
  out << "*DENSITY\n" << group.density << "\n";
  if (model.mass_damping > 0.0 || model.stiffness_damping > 0.0)
    out << "*DAMPING, ALPHA=" << model.mass_damping << ", BETA=" << model.stiffness_damping << "\n";
  out << "*SOLID SECTION, ELSET=" << name << ", MATERIAL=" << name << "\n";
}

void write_loads(const ExportedModel& model, std::ostream& out) {
  const Eigen::Matrix3Xd force = model.force();
  if (!force.isZero(0.0)) out << "*CLOAD\n";
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (force(axis, i) != 0.0) out << i + 1 << ", " << axis + 1 << ", " << force(axis, i) << "\n";
    }
  }
  const double size = model.gravity.norm();
  if (size == 0.0) return;
  const Eigen::Vector3d direction = model.gravity / size;
  out << "*DLOAD\nBODY, GRAV, " << size << ", " << direction.x() << ", " << direction.y() << ", " << direction.z() << "\n";
}

void write_motions(const ExportedModel& model, std::ostream& out) {
  for (const ExportedMotion& motion : model.motions) {
    out << "*BOUNDARY\n";
    for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        out << motion.nodes[i] + 1 << ", " << axis + 1 << ", " << axis + 1 << ", "
            << motion.displacement(axis, static_cast<Eigen::Index>(i)) << "\n";
      }
    }
  }
}

}  // namespace

ExportFile calculix_file(const ExportedModel& model) {
  const std::vector<std::string> remarks = remarks_of(model);
  std::ostringstream out;
  out.precision(kDigits);
  for (const std::string& line : head_lines(model, remarks)) write_comment(line, out);
  write_mesh(model.mesh, out);
  int number = 0;
  for (const MaterialGroup& group : material_groups(model))
    write_material(model, group, "TISSUE" + std::to_string(++number), out);
  if (const std::vector<int> fixed = fixed_nodes(model); !fixed.empty()) {
    out << "*NSET, NSET=FIXED\n";
    write_list(fixed, out);
    out << "*BOUNDARY\nFIXED, 1, 3\n";
  }
  out << (model.finite_strain ? "*STEP, NLGEOM\n*STATIC\n" : "*STEP\n*STATIC\n");
  if (model.finite_strain) out << kIncrements << "\n";
  write_motions(model, out);
  write_loads(model, out);
  out << "*NODE FILE\nU, RF\n*EL FILE\nS, E\n*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
  return {out.str(), remarks};
}

}  // namespace tissue_stiffness
