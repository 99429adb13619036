// SOFA's scene file. The names of its components are those of SOFA 23.12, where FixedConstraint became
// FixedProjectiveConstraint.
#include <limits>
#include <sstream>

#include "export/corner_forces.hpp"
#include "export/formats.hpp"
#include "export/material_groups.hpp"
#include "export/xml.hpp"
#include "meshing/elevate.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kStep = 0.01;  // [s]

std::vector<std::string> remarks_of(const ExportedModel& model) {
  std::vector<std::string> out = model.remarks;
  if (model.mesh.quadratic()) {
    out.emplace_back("SOFA has no 10-node tetrahedra; those of 4 nodes here are stiffer, most of all in bending");
  }
  if (model.finite_strain)
    out.emplace_back("the neo-Hookean law is left out: Hooke's law turns with each tetrahedron instead");
  for (const ExportedMotion& motion : model.motions) out.push_back(motion.name + " is left out: its region is free here");
  const double ratio = model.poisson_ratio[0];
  if ((model.poisson_ratio.array() != ratio).any())
    out.emplace_back("a SOFA that takes one Poisson's ratio refuses or ignores those of the other tetrahedra");
  return out;
}

void write_numbers(const Eigen::VectorXd& numbers, std::ostream& out) {
  const bool equal = (numbers.array() == numbers[0]).all();
  for (Eigen::Index i = 0; i < (equal ? 1 : numbers.size()); ++i) out << (i == 0 ? "" : " ") << numbers[i];
}

template <typename Columns>
void write_columns(const Columns& columns, std::ostream& out) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    for (Eigen::Index k = 0; k < columns.rows(); ++k) out << (i + k == 0 ? "" : " ") << columns(k, i);
  }
}

void write_body(const ExportedModel& model, const TetMesh& mesh, std::ostream& out) {
  out << "    <EulerImplicitSolver rayleighMass=\"" << model.mass_damping << "\" rayleighStiffness=\""
      << model.stiffness_damping << "\"/>\n    <SparseLDLSolver template=\"CompressedRowSparseMatrixMat3x3d\"/>\n";
  out << "    <TetrahedronSetTopologyContainer name=\"mesh\" position=\"";
  write_columns(mesh.nodes, out);
  out << "\" tetrahedra=\"";
  write_columns(mesh.tets, out);
  out << "\"/>\n    <TetrahedronSetGeometryAlgorithms template=\"Vec3\"/>\n"
         "    <MechanicalObject template=\"Vec3\" src=\"@mesh\"/>\n    <MeshMatrixMass topology=\"@mesh\" massDensity=\"";
  write_numbers(model.density, out);
  out << "\"/>\n    <TetrahedronFEMForceField template=\"Vec3\" topology=\"@mesh\" method=\""
      << (model.finite_strain ? "large" : "small") << "\" youngModulus=\"";
  write_numbers(model.young_modulus, out);
  out << "\" poissonRatio=\"";
  write_numbers(model.poisson_ratio, out);
  out << "\"/>\n";
}

void write_fixed(const ExportedModel& model, std::ostream& out) {
  const std::vector<int> nodes = fixed_corners(model);
  if (nodes.empty()) return;
  out << "    <FixedProjectiveConstraint template=\"Vec3\" indices=\"";
  for (std::size_t i = 0; i < nodes.size(); ++i) out << (i == 0 ? "" : " ") << nodes[i];
  out << "\"/>\n";
}

void write_load(const ExportedLoad& load, const TetMesh& mesh, std::ostream& out) {
  const Eigen::Matrix3Xd all = corner_forces(mesh, load.force);
  std::ostringstream indices, forces;
  forces.precision(out.precision());
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    if (all.col(i).isZero(0.0)) continue;
    indices << (indices.tellp() == 0 ? "" : " ") << i;
    forces << (forces.tellp() == 0 ? "" : " ") << all(0, i) << " " << all(1, i) << " " << all(2, i);
  }
  if (indices.str().empty()) return;
  write_comments({load.name}, out);
  out << "    <ConstantForceField template=\"Vec3\" indices=\"" << indices.str() << "\" forces=\"" << forces.str()
      << "\"/>\n";
}

}  // namespace

ExportFile sofa_file(const ExportedModel& model) {
  const std::vector<std::string> remarks = remarks_of(model);
  TetMesh mesh = model.mesh;
  if (mesh.quadratic()) drop_mid_nodes(mesh);
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "<?xml version=\"1.0\"?>\n";
  write_comments({"A scene of SOFA 23.12 or later. It settles under the loads."}, out);
  write_comments(head_lines(model, remarks), out);
  out << "<Node name=\"root\" dt=\"" << kStep << "\" gravity=\"" << model.gravity.x() << " " << model.gravity.y() << " "
      << model.gravity.z() << "\">\n";
  for (const char* plugin : {"Constraint.Projective", "LinearSolver.Direct", "Mass", "MechanicalLoad", "ODESolver.Backward",
                             "SolidMechanics.FEM.Elastic", "StateContainer", "Topology.Container.Dynamic"}) {
    out << "  <RequiredPlugin name=\"Sofa.Component." << plugin << "\"/>\n";
  }
  out << "  <DefaultAnimationLoop/>\n  <Node name=\"body\">\n";
  write_body(model, mesh, out);
  write_fixed(model, out);
  for (const ExportedLoad& load : model.loads) write_load(load, model.mesh, out);
  out << "  </Node>\n</Node>\n";
  return {out.str(), remarks};
}

}  // namespace tissue_stiffness
