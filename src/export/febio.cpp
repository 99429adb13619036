// FEBio's input file, version 4.0 of its format (User Manual, chapter 3).
#include <algorithm>
#include <limits>
#include <sstream>

#include "export/formats.hpp"
#include "export/material_groups.hpp"
#include "export/xml.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kSteps = 10;  // in which the loads rise; FEBio's analyses are not linear

std::vector<std::string> remarks_of(const ExportedModel& model) {
  std::vector<std::string> out = model.remarks;
  if (!model.finite_strain)
    out.emplace_back("FEBio has no law of small strain; its isotropic elastic one agrees for small strain and rotation");
  if (model.mass_damping > 0.0) out.emplace_back("mass_damping is left out: the analysis is static");
  if (model.stiffness_damping > 0.0) out.emplace_back("viscous_damping is left out: the analysis is static");
  return out;
}

void write_node_set(const std::string& name, const std::vector<int>& nodes, std::ostream& out) {
  out << "    <NodeSet name=\"" << name << "\">";
  for (std::size_t i = 0; i < nodes.size(); ++i) out << (i == 0 ? "" : ",") << nodes[i] + 1;
  out << "</NodeSet>\n";
}

/// Data of a node set's nodes, which are numbered within the set; a column each.
void write_node_data(const std::string& name, const std::string& set, const Eigen::MatrixXd& values, std::ostream& out) {
  out << "    <NodeData name=\"" << name << "\" node_set=\"" << set << "\" data_type=\""
      << (values.rows() == 3 ? "vec3" : "scalar") << "\">\n";
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    out << "      <node lid=\"" << i + 1 << "\">";
    for (Eigen::Index axis = 0; axis < values.rows(); ++axis) out << (axis == 0 ? "" : ",") << values(axis, i);
    out << "</node>\n";
  }
  out << "    </NodeData>\n";
}

/// A field of forces, on the nodes where it is not zero.
struct NodalForce {
  std::string name;
  std::vector<int> nodes;
  Eigen::Matrix3Xd force;

  NodalForce(std::string its_name, const Eigen::Matrix3Xd& all) : name(std::move(its_name)) {
    for (int i = 0; i < all.cols(); ++i) {
      if (!all.col(i).isZero(0.0)) nodes.push_back(i);
    }
    force.resize(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) force.col(static_cast<Eigen::Index>(i)) = all.col(nodes[i]);
  }
};

void write_control(std::ostream& out) {
  out << "  <Module type=\"solid\"/>\n  <Control>\n    <analysis>STATIC</analysis>\n    <time_steps>" << kSteps
      << "</time_steps>\n    <step_size>" << 1.0 / kSteps
      << "</step_size>\n    <solver type=\"solid\">\n      <symmetric_stiffness>symmetric</symmetric_stiffness>\n"
         "    </solver>\n  </Control>\n";
}

void write_materials(const ExportedModel& model, const std::vector<MaterialGroup>& groups, std::ostream& out) {
  out << "  <Material>\n";
  for (std::size_t i = 0; i < groups.size(); ++i) {
    out << "    <material id=\"" << i + 1 << "\" name=\"Tissue" << i + 1 << "\" type=\""
        << (model.finite_strain ? "neo-Hookean" : "isotropic elastic") << "\">\n      <density>" << groups[i].density
        << "</density>\n      <E>" << groups[i].young_modulus << "</E>\n      <v>" << groups[i].poisson_ratio
        << "</v>\n    </material>\n";
  }
  out << "  </Material>\n";
}

void write_elements(const TetMesh& mesh, const std::vector<MaterialGroup>& groups, std::ostream& out) {
  out << "    <Nodes name=\"AllNodes\">\n";
  for (int i = 0; i < mesh.node_count(); ++i) {
    out << "      <node id=\"" << i + 1 << "\">" << mesh.nodes(0, i) << "," << mesh.nodes(1, i) << "," << mesh.nodes(2, i)
        << "</node>\n";
  }
  out << "    </Nodes>\n";
  for (std::size_t i = 0; i < groups.size(); ++i) {
    out << "    <Elements type=\"" << (mesh.quadratic() ? "tet10" : "tet4") << "\" name=\"Part" << i + 1 << "\">\n";
    for (const int e : groups[i].tets) {
      out << "      <elem id=\"" << e + 1 << "\">";
      for (Eigen::Index k = 0; k < mesh.tets.rows(); ++k) out << (k == 0 ? "" : ",") << mesh.tets(k, e) + 1;
      out << "</elem>\n";
    }
    out << "    </Elements>\n";
  }
}

void write_boundary(const ExportedModel& model, bool held, std::ostream& out) {
  if (!held && model.motions.empty()) return;
  out << "  <Boundary>\n";
  if (held) {
    out << "    <bc name=\"Fixed\" type=\"zero displacement\" node_set=\"FixedNodes\">\n"
           "      <x_dof>1</x_dof>\n      <y_dof>1</y_dof>\n      <z_dof>1</z_dof>\n    </bc>\n";
  }
  for (std::size_t i = 0; i < model.motions.size(); ++i) {
    for (const char axis : {'x', 'y', 'z'}) {
      out << "    <bc name=\"Moved" << i + 1 << axis << "\" type=\"prescribed displacement\" node_set=\"MovedNodes" << i + 1
          << "\">\n      <dof>" << axis << "</dof>\n      <value lc=\"1\" type=\"map\">Motion" << i + 1 << axis
          << "</value>\n      <relative>0</relative>\n    </bc>\n";
    }
  }
  out << "  </Boundary>\n";
}

void write_loads(const std::vector<NodalForce>& forces, std::ostream& out) {
  if (forces.empty()) return;
  out << "  <Loads>\n";
  for (const NodalForce& force : forces) {
    out << "    <nodal_load name=\"" << force.name << "\" type=\"nodal_force\" node_set=\"" << force.name
        << "Nodes\">\n      <value lc=\"1\" type=\"map\">" << force.name << "Force</value>\n    </nodal_load>\n";
  }
  out << "  </Loads>\n";
}

}  // namespace

// Gravity is written as forces on the nodes, because the sign of a body force is not the same in FEBio's manual and source.
ExportFile febio_file(const ExportedModel& model) {
  const std::vector<std::string> remarks = remarks_of(model);
  const std::vector<MaterialGroup> groups = material_groups(model);
  const std::vector<int> fixed = fixed_nodes(model);
  std::vector<NodalForce> forces = {{"Load", model.force()}, {"Weight", model.weight}};
  forces.erase(std::remove_if(forces.begin(), forces.end(), [](const NodalForce& f) { return f.nodes.empty(); }),
               forces.end());
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<febio_spec version=\"4.0\">\n";
  write_comments(head_lines(model, remarks), out);
  write_control(out);
  write_materials(model, groups, out);
  out << "  <Mesh>\n";
  write_elements(model.mesh, groups, out);
  if (!fixed.empty()) write_node_set("FixedNodes", fixed, out);
  for (const NodalForce& force : forces) write_node_set(force.name + "Nodes", force.nodes, out);
  for (std::size_t i = 0; i < model.motions.size(); ++i)
    write_node_set("MovedNodes" + std::to_string(i + 1), model.motions[i].nodes, out);
  out << "  </Mesh>\n  <MeshDomains>\n";
  for (std::size_t i = 0; i < groups.size(); ++i) {
    out << "    <SolidDomain name=\"Part" << i + 1 << "\" mat=\"Tissue" << i + 1 << "\""
        << (model.mesh.quadratic() ? " elem_type=\"TET10G4\"" : "") << "/>\n";
  }
  out << "  </MeshDomains>\n";
  if (!forces.empty() || !model.motions.empty()) {
    out << "  <MeshData>\n";
    for (const NodalForce& force : forces) write_node_data(force.name + "Force", force.name + "Nodes", force.force, out);
    for (std::size_t i = 0; i < model.motions.size(); ++i) {
      const std::string number = std::to_string(i + 1);
      for (int axis = 0; axis < 3; ++axis) {
        write_node_data("Motion" + number + "xyz"[axis], "MovedNodes" + number, model.motions[i].displacement.row(axis),
                        out);
      }
    }
    out << "  </MeshData>\n";
  }
  write_boundary(model, !fixed.empty(), out);
  write_loads(forces, out);
  out << "  <LoadData>\n    <load_controller id=\"1\" type=\"loadcurve\">\n      <interpolate>LINEAR</interpolate>\n"
         "      <extend>CONSTANT</extend>\n      <points>\n        <pt>0,0</pt>\n        <pt>1,1</pt>\n      </points>\n"
         "    </load_controller>\n  </LoadData>\n  <Output>\n    <plotfile type=\"febio\">\n      <var "
         "type=\"displacement\"/>\n"
         "      <var type=\"stress\"/>\n    </plotfile>\n    <logfile>\n      <node_data data=\"ux;uy;uz\"/>\n    "
         "</logfile>\n"
         "  </Output>\n</febio_spec>\n";
  return {out.str(), remarks};
}

}  // namespace tissue_stiffness
