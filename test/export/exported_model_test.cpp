// What a model becomes before it is written in any format.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "example_model.hpp"
#include "fem/neo_hookean.hpp"
#include "fem/strain.hpp"

namespace tissue_stiffness {
namespace {

Eigen::Vector3d sum(const Eigen::Matrix3Xd& columns) {
  return columns.rowwise().sum();
}

double volume() {
  return 0.10 * 0.02 * 0.02;
}

/// The stiffness that other programs compute from the exported numbers.
SparseMatrix stiffness(const Model& model, const ExportedModel& exported) {
  SparseMatrix out = model.fem().pattern();
  const auto factor = [&](int e, int) {
    const Lame here = lame(exported.young_modulus[e], exported.poisson_ratio[e]);
    return isotropic_factor(here.lambda, here.mu);
  };
  add_strain_stiffness(model.fem(), factor, 1.0, out);
  return out;
}

/// The remark that begins with this name; empty: none.
std::string remark(const ExportedModel& model, const std::string& name) {
  for (const std::string& text : model.remarks) {
    if (text.rfind(name, 0) == 0) return text;
  }
  return "";
}

TEST(ExportedModel, HasTheModuliOfEveryRegion) {
  const ExportedModel bar = export_bar(bar_effects());
  for (int e = 0; e < bar.mesh.tet_count(); ++e) {
    const bool near = bar.mesh.nodes(0, bar.mesh.tets(0, e)) + bar.mesh.nodes(0, bar.mesh.tets(1, e)) +
                          bar.mesh.nodes(0, bar.mesh.tets(2, e)) + bar.mesh.nodes(0, bar.mesh.tets(3, e)) <
                      0.2;
    EXPECT_DOUBLE_EQ(bar.young_modulus[e], near ? 10e3 : 40e3);
    EXPECT_DOUBLE_EQ(bar.poisson_ratio[e], near ? 0.3 : 0.45);
  }
  EXPECT_FALSE(bar.finite_strain);
  EXPECT_TRUE(bar.remarks.empty());
}

TEST(ExportedModel, HasTheStiffnessOfTheModel) {
  for (const std::string more :
       {"compressibility: {shift: 0.04}", "stiff_inclusion: {excess: 2.0, center: [0.07, 0.01, 0.01], radius: 1.0}"}) {
    const auto model = bar_model(bar_effects({more}));
    const Eigen::VectorXd theta = model->parameters().known();
    const SparseMatrix expected = model->rest_stiffness(theta);
    const SparseMatrix found = stiffness(*model, export_model(*model, theta, 12.0));
    EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm()) << more;
  }
  const ExportedModel small =
      export_bar(bar_effects({"stiff_inclusion: {excess: 2.0, center: [0.02, 0.01, 0.01], radius: 0.012}"}));
  EXPECT_GT(small.young_modulus.maxCoeff(), 40e3 - 1e-6);
  EXPECT_GT(small.young_modulus.head(6).maxCoeff(), 15e3);
  EXPECT_NE(remark(small, "stiff_inclusion has one modulus in each tetrahedron"), "");
  EXPECT_NEAR(small.poisson_ratio.minCoeff(), 0.3, 1e-12) << "an inclusion is as compressible as the tissue around it";
}

TEST(ExportedModel, TakesTheModuliOfAMap) {
  const auto model =
      bar_model({"inertia: {density: 1000}",
                 "elasticity: {law: linear, young_modulus: {prior: 20.0e3, factor: 2}, poisson_ratio: 0.4}",
                 "stiff_inclusion: {excess: 1.0, center: [0.05, 0, 0], radius: 1.0}", "fixed: {region: clamp}"});
  Eigen::VectorXd map = Eigen::VectorXd::Constant(model->fem().element_count(), 30e3);
  map[2] = std::numeric_limits<double>::quiet_NaN();
  const ExportedModel mapped = export_model(*model, model->parameters().known(), 0.0, map, 20e3);
  EXPECT_NEAR(mapped.young_modulus[0], 60e3, 1e-6) << "the inclusion multiplies what the map says";
  EXPECT_NEAR(mapped.young_modulus[2], 40e3, 1e-6) << "the map says nothing here";
}

TEST(ExportedModel, HoldsTheLoadsOfAnInstant) {
  const ExportedModel bar =
      export_bar(bar_effects({"force_scale: {relative: 0.5}", "density_error: {relative: 0.1}"}), 13.0);
  EXPECT_EQ(bar.time, 3.0);
  ASSERT_EQ(bar.loads.size(), 1U);
  EXPECT_EQ(bar.loads[0].name, "traction on tip");
  EXPECT_LT((sum(bar.loads[0].force) - 1.5 * Eigen::Vector3d(0.015, 0.005, -0.01)).norm(), 1e-15);
  EXPECT_NEAR(bar.density.minCoeff(), 1155.0, 1e-9);
  EXPECT_LT((sum(bar.weight) - 1155.0 * volume() * Eigen::Vector3d(1.0, 0.0, -9.81)).norm(), 1e-12);
  for (int i = 0; i < bar.mesh.node_count(); ++i)
    EXPECT_EQ(bar.fixed[static_cast<std::size_t>(i)] != 0, bar.mesh.nodes(0, i) < 1e-6) << i;
}

TEST(ExportedModel, AddsTheErrorsOfASensorToItsLoad) {
  const ExportedModel bar = export_bar(
      bar_effects({"load_offset: {region: tip, force: [0, 0, 0.003]}", "pressure_offset: {region: tip, pressure: 10}"}));
  ASSERT_EQ(bar.loads.size(), 3U);
  EXPECT_EQ(bar.loads[1].name, "load_offset on tip");
  EXPECT_LT((sum(bar.force()) - Eigen::Vector3d(0.02 - 10 * 4e-4, 0.01, -0.037)).norm(), 1e-15);
}

TEST(ExportedModel, FindsTheLargestLoad) {
  const auto model = bar_model(bar_effects());
  const std::vector<double> times = {10.0, 14.0, 12.0, 13.0, 8.0};
  EXPECT_EQ(time_of_largest_load(*model, model->parameters().known(), times), 12.0);
  const auto idle =
      bar_model({"inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: 1000, poisson_ratio: 0.3}",
                 "fixed: {region: clamp}"});
  EXPECT_EQ(time_of_largest_load(*idle, idle->parameters().known(), times), 10.0);
}

TEST(ExportedModel, MovesARegionWithItsBody) {
  const auto model =
      bar_model({"inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: 1000, poisson_ratio: 0.3}",
                 "fixed: {region: clamp}", "moved: {region: tip, topic: /arm, smoothing: 0, compliance: 1e-7}"});
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.translation() << 0.0, 0.0, 0.002;
  turned.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  model->loads().drive(10.0,
                       {{"/arm", 10.0, pose_values(Eigen::Isometry3d::Identity())}, {"/arm", 11.0, pose_values(turned)}});
  const Eigen::VectorXd theta = model->parameters().known();
  EXPECT_EQ(time_of_largest_load(*model, theta, {10.0, 11.0, 10.5}), 11.0);
  const ExportedModel bar = export_model(*model, theta, 11.0);
  ASSERT_EQ(bar.motions.size(), 1U);
  const ExportedMotion& tip = bar.motions[0];
  EXPECT_EQ(tip.nodes, model->body().regions.at("tip").nodes);
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) {
    const Eigen::Vector3d x = bar.mesh.nodes.col(tip.nodes[i]);
    EXPECT_LT((tip.displacement.col(static_cast<Eigen::Index>(i)) - (turned * x - x)).norm(), 1e-12);
  }
  EXPECT_NE(remark(bar, "moved on tip is firm here"), "");
}

TEST(ExportedModel, NamesWhatIsLeftOut) {
  const ExportedModel bar = export_bar(bar_effects(
      {"viscoelasticity: {gamma: 0.5, tau: 0.1}", "added_mass: {region: tip, mass: 0.01}",
       "active_contraction: {amplitude: 100, direction: [1, 0, 0]}", "elastic_support: {region: clamp, compliance: 1e-6}",
       "contact_plane: {point: [0, 0, -1], normal: [0, 0, 1]}", "image_scale: {ratio: 1.1}",
       "fibre_reinforcement: {modulus: 100, direction: [1, 0, 0]}"}));
  for (const std::string name : {"viscoelasticity", "added_mass on tip", "active_contraction", "elastic_support on clamp",
                                 "contact_plane", "fibre_reinforcement"}) {
    EXPECT_EQ(remark(bar, name).rfind(name + " is left out: ", 0), 0U) << name << ": " << remark(bar, name);
  }
  EXPECT_NE(remark(bar, "image_scale").find("it belongs to a sensor"), std::string::npos);
  EXPECT_EQ(bar.remarks.size(), 7U);
  EXPECT_EQ(bar.fixed, export_bar(bar_effects()).fixed) << "without its springs a support is rigid";
  EXPECT_TRUE(export_bar(bar_effects({"viscoelasticity: {gamma: 0, tau: 0.1}"})).remarks.empty());
}

TEST(ExportedModel, TellsSmallStrainFromFiniteStrain) {
  const std::string pressed = "pressure_offset: {region: tip, pressure: 10}";
  const ExportedModel finite = export_bar(bar_effects({pressed}, "neo_hookean"));
  EXPECT_TRUE(finite.finite_strain);
  EXPECT_NE(remark(finite, "pressure_offset on tip keeps its direction"), "");
  EXPECT_TRUE(export_bar(bar_effects({"geometric_nonlinearity: {share: 1}"})).finite_strain);
  const ExportedModel blend = export_bar(bar_effects({pressed, "geometric_nonlinearity: {share: 0.4}"}));
  EXPECT_FALSE(blend.finite_strain);
  EXPECT_NE(remark(blend, "geometric_nonlinearity").find("0.4"), std::string::npos);
  EXPECT_EQ(blend.remarks.size(), 1U);
}

TEST(ExportedModel, RefusesABodyWithHoles) {
  const auto model = bar_model({"inertia: {density: 1000}", "fixed: {region: clamp}",
                                "elasticity: {law: linear, region: near, young_modulus: 1000, poisson_ratio: 0.3}"});
  EXPECT_NE(refusal([&] { export_model(*model, model->parameters().known(), 0.0); }).find("no elasticity in tetrahedron"),
            std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
