// OpenUSD's text, read by its own rules as far as the writer uses them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>

#include "example_model.hpp"
#include "export/formats.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

ExportedModel bar(int order, const std::vector<std::string>& more = {}) {
  const auto model = bar_model(bar_effects(more), make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, order));
  return export_model(*model, model->parameters().known(), 12.0);
}

/// The text between the braces of a prim: `def TYPE "NAME" ... { ... }`.
std::string prim(const std::string& text, const std::string& head) {
  const std::size_t at = text.find("def " + head);
  if (at == std::string::npos) return "";
  const std::size_t line = text.rfind('\n', at) + 1;
  const std::string indent = text.substr(line, at - line);
  const std::size_t open = text.find("\n" + indent + "{", at) + 1 + indent.size();
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    depth += text[i] == '{' ? 1 : text[i] == '}' ? -1 : 0;
    if (depth == 0) return text.substr(open, i - open + 1);
  }
  return "";
}

/// The numbers of `NAME = ...` up to the line's end, with the type before the name.
std::vector<double> numbers(const std::string& prim_text, const std::string& declaration) {
  const std::size_t at = prim_text.find(" " + declaration + " = ");
  if (at == std::string::npos) {
    ADD_FAILURE() << "no " << declaration;
    return {};
  }
  const std::size_t from = at + declaration.size() + 4;
  std::string values = prim_text.substr(from, prim_text.find('\n', from) - from);
  for (const char c : std::string("[](),")) std::replace(values.begin(), values.end(), c, ' ');
  std::istringstream in(values);
  return {std::istream_iterator<double>(in), {}};
}

double number(const std::string& prim_text, const std::string& declaration) {
  const std::vector<double> all = numbers(prim_text, declaration);
  return all.size() == 1 ? all[0] : NAN;
}

template <typename Columns>
void expect_equal(const std::vector<double>& found, const Columns& wanted) {
  ASSERT_EQ(static_cast<Eigen::Index>(found.size()), wanted.size());
  for (Eigen::Index i = 0; i < wanted.cols(); ++i) {
    for (Eigen::Index k = 0; k < wanted.rows(); ++k) {
      const double value = wanted(k, i);
      EXPECT_NEAR(found[static_cast<std::size_t>(i * wanted.rows() + k)], value, 1e-7 * std::abs(value));
    }
  }
}

TEST(UsdFile, HasTheBodyOfFourNodeTetrahedra) {
  for (const int order : {1, 2}) {
    const ExportedModel model = bar(order);
    const ExportFile file = usd_file(model);
    EXPECT_EQ(file.text.rfind("#usda 1.0\n(\n    defaultPrim = \"World\"\n", 0), 0U);
    EXPECT_EQ(std::count(file.text.begin(), file.text.end(), '{'), std::count(file.text.begin(), file.text.end(), '}'));
    const std::string tissue = prim(file.text, "TetMesh \"Tissue\"");
    expect_equal(numbers(tissue, "point3f[] points"), model.mesh.nodes.leftCols(model.mesh.corner_count));
    expect_equal(numbers(tissue, "point3f[] omniphysics:restShapePoints"),
                 model.mesh.nodes.leftCols(model.mesh.corner_count));
    expect_equal(numbers(tissue, "int4[] tetVertexIndices"), model.mesh.tets.topRows(4));
    expect_equal(numbers(tissue, "int4[] omniphysics:restTetVtxIndices"), model.mesh.tets.topRows(4));
    expect_equal(numbers(tissue, "int3[] surfaceFaceVertexIndices"), model.mesh.facets.topRows(3));
  }
}

TEST(UsdFile, HasOneModulusForEachTetrahedronAndAMaterialForEachPart) {
  const ExportedModel model = bar(1);
  const std::string text = usd_file(model).text, tissue = prim(text, "TetMesh \"Tissue\"");
  expect_equal(numbers(tissue, "float[] tissueStiffness:youngsModulus"), model.young_modulus.transpose());
  expect_equal(numbers(tissue, "float[] tissueStiffness:poissonsRatio"), model.poisson_ratio.transpose());
  expect_equal(numbers(tissue, "float[] tissueStiffness:density"), model.density.transpose());
  std::set<int> seen;
  for (const std::string part : {"1", "2"}) {
    const std::string material = prim(text, "Material \"Tissue" + part + "_Material\"");
    for (const double tet : numbers(prim(tissue, "GeomSubset \"Part" + part + "\""), "int[] indices")) {
      EXPECT_TRUE(seen.insert(static_cast<int>(tet)).second);
      const auto e = static_cast<Eigen::Index>(tet);
      EXPECT_NEAR(number(material, "float omniphysics:youngsModulus"), model.young_modulus[e], 1e-3);
      EXPECT_NEAR(number(material, "float omniphysics:poissonsRatio"), model.poisson_ratio[e], 1e-7);
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), model.mesh.tet_count());
  double mean = 0.0;
  for (int e = 0; e < model.mesh.tet_count(); ++e) mean += model.young_modulus[e] * tet_volume(model.mesh, e);
  const std::string whole = prim(text, "Material \"Tissue_Material\"");
  EXPECT_NEAR(number(whole, "float omniphysics:youngsModulus"), mean / mesh_volume(model.mesh), 1e-3);
  EXPECT_EQ(number(whole, "float omniphysics:density"), 1050.0);
}

TEST(UsdFile, HasOneMaterialWhereAllIsEqual) {
  const ExportFile file = usd_file(
      export_bar({"inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: 1000, poisson_ratio: 0.3}"}));
  EXPECT_EQ(file.text.find("GeomSubset"), std::string::npos);
  EXPECT_EQ(file.text.find("Attachment"), std::string::npos) << "nothing is held";
  EXPECT_NEAR(number(prim(file.text, "Material \"Tissue_Material\""), "float omniphysics:youngsModulus"), 1000.0, 1e-4);
  EXPECT_EQ(number(prim(file.text, "PhysicsScene \"Scene\""), "float physics:gravityMagnitude"), 0.0);
}

TEST(UsdFile, HasSupportGravityAndLoads) {
  for (const int order : {1, 2}) {
    const ExportedModel model = bar(order);
    const std::string text = usd_file(model).text;
    const std::string fixed = prim(text, "OmniPhysicsVtxXformAttachment \"Fixed\"");
    const std::vector<double> nodes = numbers(fixed, "int[] omniphysics:vtxIndicesSrc0");
    std::set<int> held;
    for (const double node : nodes) held.insert(static_cast<int>(node));
    for (int i = 0; i < model.mesh.corner_count; ++i)
      EXPECT_EQ(held.count(i) == 1, model.fixed[static_cast<std::size_t>(i)] != 0) << i;
    const std::vector<double> places = numbers(fixed, "point3f[] omniphysics:localPositionsSrc1");
    ASSERT_EQ(places.size(), 3 * nodes.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(places[i], model.mesh.nodes(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(nodes[i / 3])),
                  1e-9);
    const std::string scene = prim(text, "PhysicsScene \"Scene\"");
    const std::vector<double> along = numbers(scene, "vector3f physics:gravityDirection");
    const double strength = number(scene, "float physics:gravityMagnitude");
    ASSERT_EQ(along.size(), 3U);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(strength * along[axis], model.gravity[static_cast<Eigen::Index>(axis)], 1e-6);
    const std::vector<double> load = numbers(prim(text, "TetMesh \"Tissue\""), "vector3f[] tissueStiffness:load");
    ASSERT_EQ(static_cast<int>(load.size()), 3 * model.mesh.corner_count);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < load.size(); ++i) sum[static_cast<Eigen::Index>(i % 3)] += load[i];
    EXPECT_LT((sum - Eigen::Vector3d(0.02, 0.01, -0.04)).norm(), 1e-8);
  }
}

TEST(UsdFile, SaysWhatItLeavesOut) {
  ExportedModel model = bar(2, {"mass_damping: {alpha: 2.5}", "viscous_damping: {beta: 1.0e-3}"});
  model.title = "a \"soft\" bar";
  model.motions.push_back({"moved on tip", {3}, Eigen::Matrix3Xd::Zero(3, 1)});
  const ExportFile file = usd_file(model);
  EXPECT_NE(file.text.find("\"a 'soft' bar\""), std::string::npos);
  ASSERT_EQ(file.remarks.size(), 6U);
  const std::vector<std::string> words = {"no 10-node",   "one material",    "no forces",
                                          "mass_damping", "viscous_damping", "moved on tip is left out"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_NE(file.remarks[i].find(words[i]), std::string::npos) << file.remarks[i];
    EXPECT_NE(file.text.find("\"Note: " + file.remarks[i] + "\""), std::string::npos) << file.remarks[i];
  }
}

}  // namespace
}  // namespace tissue_stiffness
