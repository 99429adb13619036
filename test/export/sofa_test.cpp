// SOFA's scene, read by an XML parser.
#include <gtest/gtest.h>

#include <set>

#include "example_model.hpp"
#include "export/formats.hpp"
#include "xml_element.hpp"

namespace tissue_stiffness {
namespace {

std::vector<double> numbers(const XmlElement& component, const std::string& key) {
  return numbers_of(component.attribute(key));
}

ExportedModel bar(int order, const std::vector<std::string>& more = {}) {
  const auto model = bar_model(bar_effects(more), make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, order));
  return export_model(*model, model->parameters().known(), 12.0);
}

TEST(SofaFile, HasTheBodyOfFourNodeTetrahedra) {
  for (const int order : {1, 2}) {
    const ExportedModel model = bar(order, {"mass_damping: {alpha: 2.5}", "viscous_damping: {beta: 1.0e-3}"});
    const XmlElement root(sofa_file(model).text);
    ASSERT_TRUE(root.exists()) << "not well-formed";
    EXPECT_EQ(root.name(), "Node");
    EXPECT_EQ(numbers(root, "gravity"), (std::vector<double>{1.0, 0.0, -9.81}));
    const XmlElement body = root.child("Node");
    const XmlElement mesh = body.child("TetrahedronSetTopologyContainer");
    const std::vector<double> position = numbers(mesh, "position"), tetrahedra = numbers(mesh, "tetrahedra");
    ASSERT_EQ(static_cast<int>(position.size()), 3 * model.mesh.corner_count);
    ASSERT_EQ(static_cast<int>(tetrahedra.size()), 4 * model.mesh.tet_count());
    for (std::size_t i = 0; i < position.size(); ++i) EXPECT_EQ(position[i], model.mesh.nodes.data()[i]);
    for (std::size_t i = 0; i < tetrahedra.size(); ++i)
      EXPECT_EQ(tetrahedra[i], model.mesh.tets(static_cast<Eigen::Index>(i % 4), static_cast<Eigen::Index>(i / 4)));
    EXPECT_EQ(body.child("EulerImplicitSolver").attribute("rayleighMass"), "2.5");
    EXPECT_EQ(numbers(body.child("EulerImplicitSolver"), "rayleighStiffness"), std::vector<double>{1e-3});
    EXPECT_EQ(numbers(body.child("MeshMatrixMass"), "massDensity"), std::vector<double>{1050.0});
  }
}

TEST(SofaFile, HasOneModulusForEachTetrahedron) {
  const ExportedModel model = bar(2);
  const XmlElement root(sofa_file(model).text);
  const XmlElement law = root.child("Node").child("TetrahedronFEMForceField");
  EXPECT_EQ(law.attribute("method"), "small");
  const std::vector<double> young = numbers(law, "youngModulus"), ratio = numbers(law, "poissonRatio");
  ASSERT_EQ(static_cast<int>(young.size()), model.mesh.tet_count());
  ASSERT_EQ(young.size(), ratio.size());
  for (std::size_t e = 0; e < young.size(); ++e) {
    EXPECT_EQ(young[e], model.young_modulus[static_cast<Eigen::Index>(e)]);
    EXPECT_EQ(ratio[e], model.poisson_ratio[static_cast<Eigen::Index>(e)]);
  }
  const ExportedModel uniform =
      export_bar({"inertia: {density: 1000}", "elasticity: {law: neo_hookean, young_modulus: 1000, poisson_ratio: 0.3}"});
  const XmlElement plain(sofa_file(uniform).text);
  const XmlElement turning = plain.child("Node").child("TetrahedronFEMForceField");
  EXPECT_EQ(turning.attribute("method"), "large");
  EXPECT_EQ(numbers(turning, "youngModulus").size(), 1U);
  EXPECT_FALSE(plain.child("Node").child("FixedProjectiveConstraint").exists()) << "nothing is held";
}

TEST(SofaFile, HasSupportsAndLoads) {
  for (const int order : {1, 2}) {
    const ExportedModel model = bar(order);
    const XmlElement root(sofa_file(model).text);
    const XmlElement body = root.child("Node");
    std::set<int> held;
    for (const double node : numbers(body.child("FixedProjectiveConstraint"), "indices"))
      held.insert(static_cast<int>(node));
    for (int i = 0; i < model.mesh.corner_count; ++i)
      EXPECT_EQ(held.count(i) == 1, model.fixed[static_cast<std::size_t>(i)] != 0) << i;
    const XmlElement load = body.child("ConstantForceField");
    const std::vector<double> indices = numbers(load, "indices"), forces = numbers(load, "forces");
    ASSERT_EQ(forces.size(), 3 * indices.size());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < indices.size(); ++i) {
      ASSERT_LT(indices[i], model.mesh.corner_count);
      const Eigen::Vector3d force(forces[3 * i], forces[3 * i + 1], forces[3 * i + 2]);
      sum += force;
      torque += Eigen::Vector3d(model.mesh.nodes.col(static_cast<int>(indices[i]))).cross(force);
    }
    const Eigen::Vector3d total(0.02, 0.01, -0.04), middle(0.1, 0.01, 0.01);
    EXPECT_LT((sum - total).norm(), 1e-12);
    EXPECT_LT((torque - middle.cross(total)).norm(), 1e-12) << "the force acts in the middle of the tip";
  }
}

TEST(SofaFile, NamesItsVersionItsPluginsAndWhatItLeavesOut) {
  ExportedModel model = bar(2);
  model.motions.push_back({"moved on tip", {3}, Eigen::Matrix3Xd::Zero(3, 1)});
  const ExportFile file = sofa_file(model);
  EXPECT_NE(file.text.find("SOFA 23.12 or later"), std::string::npos);
  ASSERT_EQ(file.remarks.size(), 3U);
  EXPECT_NE(file.remarks[0].find("no 10-node tetrahedra"), std::string::npos);
  EXPECT_EQ(file.remarks[1], "moved on tip is left out: its region is free here");
  EXPECT_NE(file.remarks[2].find("one Poisson's ratio"), std::string::npos);
  for (const std::string& remark : file.remarks)
    EXPECT_NE(file.text.find("<!-- Note: " + remark + " -->"), std::string::npos) << remark;
  std::set<std::string> plugins;
  const XmlElement root(file.text);
  for (const XmlElement& plugin : root.children("RequiredPlugin")) plugins.insert(plugin.attribute("name"));
  EXPECT_EQ(plugins.count("Sofa.Component.SolidMechanics.FEM.Elastic"), 1U);
  EXPECT_EQ(plugins.count("Sofa.Component.Constraint.Projective"), 1U);
}

}  // namespace
}  // namespace tissue_stiffness
