// FEBio's input file, version 4.0: what its User Manual demands (chapter 3), read by an XML parser.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "example_model.hpp"
#include "export/formats.hpp"
#include "xml_element.hpp"

namespace tissue_stiffness {
namespace {

/// Numbers of a node set, from 0.
std::vector<int> nodes_of(const XmlElement& mesh, const std::string& name) {
  std::vector<int> out;
  for (const XmlElement& set : mesh.children("NodeSet")) {
    if (set.attribute("name") != name) continue;
    for (const double number : numbers_of(set.text())) out.push_back(static_cast<int>(number) - 1);
  }
  return out;
}

/// Data of a node set, a column for each node of the body.
Eigen::MatrixXd node_data(const XmlElement& root, const std::string& name, int nodes) {
  for (const XmlElement& data : root.child("MeshData").children("NodeData")) {
    if (data.attribute("name") != name) continue;
    const int rows = data.attribute("data_type") == "vec3" ? 3 : 1;
    const std::vector<int> set = nodes_of(root.child("Mesh"), data.attribute("node_set"));
    const std::vector<XmlElement> entries = data.children("node");
    EXPECT_EQ(entries.size(), set.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, nodes);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      EXPECT_EQ(entries[i].attribute("lid"), std::to_string(i + 1));
      const std::vector<double> numbers = numbers_of(entries[i].text());
      EXPECT_EQ(static_cast<int>(numbers.size()), rows);
      for (int k = 0; k < rows; ++k) out(k, set[i]) = numbers[static_cast<std::size_t>(k)];
    }
    return out;
  }
  ADD_FAILURE() << "no NodeData " << name;
  return Eigen::MatrixXd::Zero(3, nodes);
}

double number(const XmlElement& element) {
  const std::vector<double> numbers = numbers_of(element.text());
  return numbers.size() == 1 ? numbers[0] : std::numeric_limits<double>::quiet_NaN();
}

class Febio : public ::testing::TestWithParam<int> {
 protected:
  ExportedModel bar(const std::vector<std::string>& more = {}, const std::string& law = "linear") const {
    const auto model = bar_model(bar_effects(more, law), make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, GetParam()));
    return export_model(*model, model->parameters().known(), 12.0);
  }
};

TEST_P(Febio, HasTheSectionsInTheManualsOrder) {
  const XmlElement root(febio_file(bar()).text);
  ASSERT_TRUE(root.exists()) << "not well-formed";
  EXPECT_EQ(root.name(), "febio_spec");
  EXPECT_EQ(root.attribute("version"), "4.0");
  std::vector<std::string> sections;
  for (const XmlElement& section : root.children()) sections.push_back(section.name());
  EXPECT_EQ(sections, (std::vector<std::string>{"Module", "Control", "Material", "Mesh", "MeshDomains", "MeshData",
                                                "Boundary", "Loads", "LoadData", "Output"}));
  EXPECT_EQ(root.child("Module").attribute("type"), "solid");
  EXPECT_EQ(root.child("Control").child("analysis").text(), "STATIC");
  EXPECT_EQ(number(root.child("Control").child("time_steps")) * number(root.child("Control").child("step_size")), 1.0);
  EXPECT_EQ(root.child("Control").child("solver").attribute("type"), "solid");
  const XmlElement controller = root.child("LoadData").child("load_controller");
  EXPECT_EQ(controller.attribute("id"), "1");
  EXPECT_EQ(controller.attribute("type"), "loadcurve");
  EXPECT_EQ(controller.child("points").children("pt").back().text(), "1,1");
}

TEST_P(Febio, HasMeshAndMaterials) {
  const ExportedModel model = bar({"stiff_inclusion: {excess: 2.0, center: [0.02, 0.01, 0.01], radius: 0.012}"});
  const XmlElement root(febio_file(model).text);
  const std::vector<XmlElement> nodes = root.child("Mesh").child("Nodes").children("node");
  ASSERT_EQ(static_cast<int>(nodes.size()), model.mesh.node_count());
  for (int i = 0; i < model.mesh.node_count(); ++i) {
    const XmlElement& node = nodes[static_cast<std::size_t>(i)];
    EXPECT_EQ(node.attribute("id"), std::to_string(i + 1));
    EXPECT_EQ(numbers_of(node.text()),
              (std::vector<double>{model.mesh.nodes(0, i), model.mesh.nodes(1, i), model.mesh.nodes(2, i)}));
  }
  std::map<std::string, XmlElement> materials;
  for (const XmlElement& material : root.child("Material").children("material"))
    materials.emplace(material.attribute("name"), material);
  std::map<std::string, std::string> domains;
  for (const XmlElement& domain : root.child("MeshDomains").children("SolidDomain"))
    domains[domain.attribute("name")] = domain.attribute("mat");
  std::set<int> seen;
  for (const XmlElement& part : root.child("Mesh").children("Elements")) {
    EXPECT_EQ(part.attribute("type"), GetParam() == 1 ? "tet4" : "tet10");
    ASSERT_EQ(materials.count(domains[part.attribute("name")]), 1U);
    const XmlElement& material = materials.at(domains[part.attribute("name")]);
    EXPECT_EQ(material.attribute("type"), "isotropic elastic");
    for (const XmlElement& elem : part.children("elem")) {
      const int e = std::stoi(elem.attribute("id")) - 1;
      EXPECT_TRUE(seen.insert(e).second);
      EXPECT_EQ(number(material.child("E")), model.young_modulus[e]);
      EXPECT_EQ(number(material.child("v")), model.poisson_ratio[e]);
      EXPECT_EQ(number(material.child("density")), model.density[e]);
      const std::vector<double> corners = numbers_of(elem.text());
      ASSERT_EQ(static_cast<Eigen::Index>(corners.size()), model.mesh.tets.rows());
      for (std::size_t k = 0; k < corners.size(); ++k)
        EXPECT_EQ(corners[k], model.mesh.tets(static_cast<Eigen::Index>(k), e) + 1);
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), model.mesh.tet_count());
}

TEST_P(Febio, HasSupportsAndLoads) {
  const ExportedModel model = bar();
  const XmlElement root(febio_file(model).text);
  const XmlElement held = root.child("Boundary").child("bc");
  EXPECT_EQ(held.attribute("type"), "zero displacement");
  for (const std::string dof : {"x_dof", "y_dof", "z_dof"}) EXPECT_EQ(held.child(dof).text(), "1");
  std::vector<char> fixed(model.fixed.size(), 0);
  for (const int node : nodes_of(root.child("Mesh"), held.attribute("node_set"))) fixed[static_cast<std::size_t>(node)] = 1;
  EXPECT_EQ(fixed, model.fixed);
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, model.mesh.node_count());
  for (const XmlElement& load : root.child("Loads").children("nodal_load")) {
    EXPECT_EQ(load.attribute("type"), "nodal_force");
    EXPECT_EQ(load.child("value").attribute("lc"), "1");
    EXPECT_EQ(load.child("value").attribute("type"), "map");
    force += node_data(root, load.child("value").text(), model.mesh.node_count());
  }
  EXPECT_LT((force - model.force() - model.weight).norm(), 1e-15);
  EXPECT_GT(force.norm(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Orders, Febio, ::testing::Values(1, 2));

TEST(FebioFile, HasPrescribedMotions) {
  ExportedModel model = export_bar(bar_effects());
  model.motions.push_back({"moved on tip", {3, 5}, Eigen::Matrix3Xd::Zero(3, 2)});
  model.motions[0].displacement << 1, 2, 3, 4, 5, 6;
  const XmlElement root(febio_file(model).text);
  Eigen::MatrixXd found(3, model.mesh.node_count());
  const std::vector<XmlElement> conditions = root.child("Boundary").children("bc");
  ASSERT_EQ(conditions.size(), 4U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const XmlElement& condition = conditions[1 + axis];
    EXPECT_EQ(condition.attribute("type"), "prescribed displacement");
    EXPECT_EQ(condition.child("dof").text(), std::string(1, "xyz"[axis]));
    EXPECT_EQ(condition.child("value").attribute("lc"), "1");
    found.row(static_cast<Eigen::Index>(axis)) =
        node_data(root, condition.child("value").text(), model.mesh.node_count()).row(0);
  }
  EXPECT_EQ(found.col(3), Eigen::Vector3d(1, 3, 5));
  EXPECT_EQ(found.col(5), Eigen::Vector3d(2, 4, 6));
}

TEST(FebioFile, HasTheLawOfTheModelAndSaysWhatItLeavesOut) {
  ExportedModel model = export_bar(bar_effects({"viscous_damping: {beta: 1.0e-3}"}, "neo_hookean"));
  model.title = "estimate --output <out> & more---";
  const ExportFile file = febio_file(model);
  const XmlElement root(file.text);
  ASSERT_TRUE(root.exists()) << "not well-formed";
  EXPECT_EQ(root.child("Material").child("material").attribute("type"), "neo-Hookean");
  EXPECT_EQ(file.remarks, std::vector<std::string>{"viscous_damping is left out: the analysis is static"});
  EXPECT_NE(file.text.find("<!-- Note: viscous_damping is left out"), std::string::npos);
  EXPECT_EQ(febio_file(export_bar(bar_effects())).remarks.size(), 1U) << "no law of small strain";
}

}  // namespace
}  // namespace tissue_stiffness
