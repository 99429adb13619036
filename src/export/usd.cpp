// OpenUSD's text format, with the schemas of deformable bodies in Omni Physics 107 and later. TetMesh is in OpenUSD 24.03.
#include <limits>
#include <sstream>

#include "export/corner_forces.hpp"
#include "export/formats.hpp"
#include "export/material_groups.hpp"
#include "meshing/elevate.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

std::vector<std::string> remarks_of(const ExportedModel& model, bool several_materials) {
  std::vector<std::string> out = model.remarks;
  if (model.mesh.quadratic())
    out.emplace_back("OpenUSD has no 10-node tetrahedra; those of 4 nodes here are stiffer, most of all in bending");
  if (model.finite_strain)
    out.emplace_back("the neo-Hookean law is left out: Omni Physics turns Hooke's law with each tetrahedron");
  if (several_materials)
    out.emplace_back("Omni Physics takes one material a body, here the mean by volume; subsets have the others");
  if (!model.loads.empty())
    out.emplace_back("OpenUSD has no forces on points: the attribute tissueStiffness:load has them, nothing applies them");
  if (model.mass_damping > 0.0) out.emplace_back("mass_damping is left out: the schemas have none");
  if (model.stiffness_damping > 0.0) out.emplace_back("viscous_damping is left out: the schemas have none");
  for (const ExportedMotion& motion : model.motions) out.push_back(motion.name + " is left out: its region is free here");
  return out;
}

// A text in quotes; what ends it early or starts an escape is replaced.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '"' ? '\'' : c == '\\' ? '/' : c;
  return "\"" + out + "\"";
}

/// Writes `[a, b]`, or with several rows `[(a, b), (c, d)]`, a tuple for each column.
template <typename Columns>
void write_array(const Columns& columns, std::ostream& out) {
  const bool tuples = columns.rows() > 1;
  out << "[";
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    out << (i == 0 ? "" : ", ") << (tuples ? "(" : "");
    for (Eigen::Index k = 0; k < columns.rows(); ++k) out << (k == 0 ? "" : ", ") << columns(k, i);
    out << (tuples ? ")" : "");
  }
  out << "]\n";
}

template <typename Columns>
void write_attribute(const std::string& declaration, const Columns& columns, std::ostream& out) {
  out << "        " << declaration << " = ";
  write_array(columns, out);
}

Eigen::RowVectorXi indices_of(const std::vector<int>& list) {
  return Eigen::Map<const Eigen::RowVectorXi>(list.data(), static_cast<Eigen::Index>(list.size()));
}

MaterialGroup mean_material(const ExportedModel& model) {
  MaterialGroup mean{0.0, 0.0, 0.0, {}};
  double volume = 0.0;
  for (int e = 0; e < model.mesh.tet_count(); ++e) {
    const double part = tet_volume(model.mesh, e);
    mean.young_modulus += part * model.young_modulus[e];
    mean.poisson_ratio += part * model.poisson_ratio[e];
    mean.density += part * model.density[e];
    volume += part;
  }
  mean.young_modulus /= volume;
  mean.poisson_ratio /= volume;
  mean.density /= volume;
  return mean;
}

void write_head(const ExportedModel& model, const std::vector<std::string>& remarks, std::ostream& out) {
  out << "#usda 1.0\n(\n    defaultPrim = \"World\"\n    customLayerData = {\n        string[] notes = [";
  const std::vector<std::string> lines = head_lines(model, remarks);
  for (std::size_t i = 0; i < lines.size(); ++i) out << (i == 0 ? "" : ", ") << quoted(lines[i]);
  out << "]\n    }\n    kilogramsPerUnit = 1\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n";
}

void write_gravity(const Eigen::Vector3d& gravity, std::ostream& out) {
  const Eigen::Vector3d along = gravity.isZero(0.0) ? Eigen::Vector3d(0.0, 0.0, -1.0) : gravity.normalized();
  out << "    def PhysicsScene \"Scene\"\n    {\n        vector3f physics:gravityDirection = (" << along.x() << ", "
      << along.y() << ", " << along.z() << ")\n        float physics:gravityMagnitude = " << gravity.norm()
      << "\n    }\n\n";
}

void write_material(const std::string& name, const MaterialGroup& group, std::ostream& out) {
  out << "    def Material \"" << name
      << "\" (\n        prepend apiSchemas = [\"OmniPhysicsBaseMaterialAPI\", \"OmniPhysicsDeformableMaterialAPI\"]\n"
         "    )\n    {\n        float omniphysics:density = "
      << group.density << "\n        float omniphysics:poissonsRatio = " << group.poisson_ratio
      << "\n        float omniphysics:youngsModulus = " << group.young_modulus << "\n    }\n\n";
}

void write_subset(std::size_t number, const std::vector<int>& tets, std::ostream& out) {
  out << "\n        def GeomSubset \"Part" << number
      << "\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n        {\n"
         "            uniform token elementType = \"tetrahedron\"\n"
         "            uniform token familyName = \"materialBind\"\n            int[] indices = ";
  write_array(indices_of(tets), out);
  out << "            rel material:binding:physics = </World/Tissue" << number << "_Material>\n        }\n";
}

void write_mesh(const TetMesh& mesh, std::ostream& out) {
  Eigen::Matrix<double, 3, 2> extent;
  extent << mesh.nodes.rowwise().minCoeff(), mesh.nodes.rowwise().maxCoeff();
  write_attribute("float3[] extent", extent, out);
  out << "        rel material:binding:physics = </World/Tissue_Material>\n";
  write_attribute("point3f[] omniphysics:restShapePoints", mesh.nodes, out);
  write_attribute("int4[] omniphysics:restTetVtxIndices", mesh.tets, out);
  out << "        uniform token orientation = \"rightHanded\"\n";
  write_attribute("point3f[] points", mesh.nodes, out);
  write_attribute("int3[] surfaceFaceVertexIndices", mesh.facets.topRows(3), out);
  write_attribute("int4[] tetVertexIndices", mesh.tets, out);
}

void write_attachment(const TetMesh& mesh, const std::vector<int>& fixed, std::ostream& out) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(fixed.size()));
  for (std::size_t i = 0; i < fixed.size(); ++i) places.col(static_cast<Eigen::Index>(i)) = mesh.nodes.col(fixed[i]);
  out << "\n    def Xform \"Support\"\n    {\n    }\n\n    def OmniPhysicsVtxXformAttachment \"Fixed\"\n    {\n"
         "        rel omniphysics:src0 = </World/Tissue>\n        rel omniphysics:src1 = </World/Support>\n";
  write_attribute("int[] omniphysics:vtxIndicesSrc0", indices_of(fixed), out);
  write_attribute("point3f[] omniphysics:localPositionsSrc1", places, out);
  out << "    }\n";
}

}  // namespace

ExportFile usd_file(const ExportedModel& model) {
  const std::vector<MaterialGroup> groups = material_groups(model);
  const bool several = groups.size() > 1;
  const std::vector<std::string> remarks = remarks_of(model, several);
  TetMesh mesh = model.mesh;
  if (mesh.quadratic()) drop_mid_nodes(mesh);
  const std::vector<int> fixed = fixed_corners(model);
  std::ostringstream out;
  out.precision(std::numeric_limits<float>::max_digits10);  // the format's numbers are of single precision
  write_head(model, remarks, out);
  out << "def Xform \"World\"\n{\n";
  write_gravity(model.gravity, out);
  write_material("Tissue_Material", several ? mean_material(model) : groups[0], out);
  for (std::size_t i = 0; several && i < groups.size(); ++i)
    write_material("Tissue" + std::to_string(i + 1) + "_Material", groups[i], out);
  out << "    def TetMesh \"Tissue\" (\n        prepend apiSchemas = [\"OmniPhysicsDeformableBodyAPI\", "
         "\"OmniPhysicsVolumeDeformableSimAPI\", \"PhysicsCollisionAPI\", \"MaterialBindingAPI\"]\n    )\n    {\n";
  write_mesh(mesh, out);
  write_attribute("custom float[] tissueStiffness:density", model.density.transpose(), out);
  write_attribute("custom vector3f[] tissueStiffness:load", corner_forces(model.mesh, model.force()), out);
  write_attribute("custom float[] tissueStiffness:poissonsRatio", model.poisson_ratio.transpose(), out);
  write_attribute("custom float[] tissueStiffness:youngsModulus", model.young_modulus.transpose(), out);
  for (std::size_t i = 0; several && i < groups.size(); ++i) write_subset(i + 1, groups[i].tets, out);
  out << "    }\n";
  if (!fixed.empty()) write_attachment(mesh, fixed, out);
  out << "}\n";
  return {out.str(), remarks};
}

}  // namespace tissue_stiffness
