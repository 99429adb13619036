// What each effect declares to do, against sums and decays by hand.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "../static_sag.hpp"
#include "body_forces.hpp"
#include "fem/generalized_alpha.hpp"
#include "meshing/elevate.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kVolume = 0.10 * 0.02 * 0.02, kDensity = 1000.0;
const std::string kFinite = "elasticity: {law: neo_hookean, young_modulus: 3.0e4, poisson_ratio: 0.4}";

TEST(Gravity, WeighsTheBodyAndTheAddedMass) {
  const TetMesh mesh = bar_mesh();
  Model model(
      box_settings({kInertia, kLinear, "added_mass: {region: tip, mass: 0.05}", "gravity: {acceleration: [1, -2, -9.81]}"}),
      mesh);
  const Eigen::Vector3d weight = (kDensity * kVolume + 0.05) * Eigen::Vector3d(1.0, -2.0, -9.81);
  EXPECT_LT((resultant(load(model, 0.0, zero(model))) - weight).norm(), 1e-12 * weight.norm());
}

TEST(Gravity, LetsABodyWithAddedMassFallFreely) {
  const TetMesh mesh = bar_mesh();
  Model model(
      box_settings({kInertia, kLinear, "added_mass: {region: tip, mass: 0.05}", "gravity: {acceleration: [0, 0, -9.81]}"}),
      mesh);
  FullModel::Options options;
  options.step = 0.01;
  const auto run = FullModel(model, options).start(prior(model), 0.0);
  run->advance(0.1);
  for (int i = 0; i < mesh.node_count(); ++i) {
    EXPECT_NEAR(run->displacement()[3 * i + 2], -0.5 * 9.81 * 0.01, 1e-10);
  }
}

TEST(AddedMass, SitsOnItsRegion) {
  const TetMesh mesh = bar_mesh();
  const Model bare(box_settings({kInertia, kLinear}), mesh);
  const Model loaded(box_settings({kInertia, kLinear, "added_mass: {region: tip, mass: 0.05}"}), mesh);
  const SparseMatrix extra = loaded.mass(prior(loaded)) - bare.mass(prior(bare));
  for (int i = 0; i < mesh.node_count(); ++i) {
    const double row = extra.row(3 * i).sum();
    EXPECT_TRUE(row == 0.0 || mesh.nodes(0, i) > 0.1 - 1e-9);
  }
  // Rotary inertia about y of a thin square plate at x = 0.1: m (x^2 + (z^2 mean)).
  Eigen::VectorXd spin = zero(loaded);
  for (int i = 0; i < mesh.node_count(); ++i) {
    spin.segment<3>(3 * i) = Eigen::Vector3d::UnitY().cross(mesh.nodes.col(i));
  }
  EXPECT_NEAR(spin.dot(extra * spin), 0.05 * (0.1 * 0.1 + 0.02 * 0.02 / 3.0), 1e-12);
}

// Returns the mass that each node carries.
Eigen::VectorXd lump(const std::string& place) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  const Model bare(box_settings({kInertia, kLinear}), mesh);
  const Model loaded(box_settings({kInertia, kLinear, "added_mass: {" + place + ", mass: 0.05}"}), mesh);
  const SparseMatrix extra = loaded.mass(prior(loaded)) - bare.mass(prior(bare));
  Eigen::VectorXd out(mesh.node_count());
  for (int i = 0; i < mesh.node_count(); ++i) out[i] = extra.row(3 * i).sum();
  return out;
}

TEST(AddedMass, IsALumpAboutItsPlace) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  double last = 0.0;
  for (const double x : {0.03, 0.032, 0.07}) {
    const Eigen::VectorXd mass = lump("center: [" + std::to_string(x) + ", 0, 0]");
    EXPECT_NEAR(mass.sum(), 0.05, 1e-7);
    const double middle = mesh.nodes.row(0).dot(mass) / mass.sum();
    EXPECT_NEAR(middle, x, 0.005);
    EXPECT_GT(middle, last + 5e-4) << "the lump does not move with its place";
    last = middle;
  }
  const Eigen::VectorXd known = lump("center: [0.03, 0, 0]"), estimated = lump("center: {mean: [0.03, 0, 0], std: 0.01}");
  EXPECT_LT((known - estimated).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(AddedMass, NeedsARegionOrAPlace) {
  EXPECT_THROW(lump("region: tip, center: [0, 0, 0]"), InputError);
  const std::vector<std::string> nowhere{kInertia, kLinear, "added_mass: {mass: 0.05}"};
  EXPECT_THROW(Model(box_settings(nowhere), bar_mesh()), InputError);
}

Eigen::VectorXd one(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

// Stiffness against a shift as a whole, over the stiffness per area: the area that is held.
double held_area(const std::string& foundation) {
  const TetMesh mesh = bar_mesh();
  const std::vector<std::string> base{kInertia, kLinear, "fixed: {region: clamp}"};
  std::vector<std::string> more = base;
  more.push_back("foundation: {" + foundation + "stiffness: 500}");
  const Model bare(box_settings(base), mesh), resting(box_settings(more), mesh);
  Eigen::VectorXd shift = zero(bare);
  for (int i = 0; i < mesh.node_count(); ++i) shift[3 * i + 1] = 1.0;
  return shift.dot(resting.stiffness(prior(resting)) * shift - bare.stiffness(prior(bare)) * shift) / 500.0;
}

TEST(Foundation, HoldsTheSideThatFacesADirection) {
  const double side = 0.10 * 0.02, end = 0.02 * 0.02;
  EXPECT_NEAR(held_area(""), 4.0 * side + end, 1e-9);
  EXPECT_NEAR(held_area("facing: [0, 0, -1], "), side, 1e-9);
  EXPECT_NEAR(held_area("facing: [3, 0, 0], "), end, 1e-9);
  EXPECT_NEAR(held_area("facing: [0, 1, 1], "), 2.0 * side, 1e-9);
  EXPECT_NEAR(held_area("region: skin, facing: [-1, 0, 0], "), end, 1e-9);
  EXPECT_EQ(refusal([] { held_area("facing: [-1, 0, 0], "); }),
            "model.yaml:13: effects[3].foundation.facing: found [-1, 0, 0]; allowed: a direction that a part of the "
            "surface faces");
  EXPECT_NE(refusal([] { held_area("facing: [0, 0, 0], "); }), "");
}

Eigen::VectorXd sag(const std::vector<std::string>& clamps) {
  std::vector<std::string> effects{kInertia, kLinear, "gravity: {acceleration: [0, 0, -9.81]}"};
  effects.insert(effects.end(), clamps.begin(), clamps.end());
  return static_sag(Model(box_settings(effects), bar_mesh(8)));
}

// A clamp that is drawn over half of the bar, and that holds only its end.
TEST(ElasticSupport, ReleasesAClampNearItsEdge) {
  const Eigen::VectorXd whole = sag({"fixed: {region: clamp}"}), half = sag({"fixed: {region: near}"});
  const std::string free = "compliance: 1.0}";
  const Eigen::VectorXd released = sag({"fixed: {region: near}", "elastic_support: {region: near, within: 0.05, " + free});
  EXPECT_LT((released - whole).norm(), 1e-3 * whole.norm());
  EXPECT_GT((half - whole).norm(), 0.5 * whole.norm()) << "no test: the clamp's depth makes no difference";
  const Eigen::VectorXd rigid =
      sag({"fixed: {region: near}", "elastic_support: {region: near, within: 0.05, compliance: 0}"});
  EXPECT_LT((rigid - half).norm(), 1e-9 * half.norm());
  const auto too_little = [&] { sag({"fixed: {region: near}", "elastic_support: {region: near, within: 0.001, " + free}); };
  EXPECT_NE(refusal(too_little).find("elastic_support.within: found 0.001; allowed: at least 0.006"), std::string::npos)
      << refusal(too_little);
}

// A flat end of which a half is held: the other half lies beside it in its plane.
TEST(Foundation, HoldsWhatLiesBesideAClampInItsPlane) {
  ModelSettings settings =
      box_settings({kInertia, kLinear, "fixed: {region: clamp}", "foundation: {level_with: clamp, stiffness: 500}"});
  settings.regions.front().shape = BoxShape{{-1.0, -1.0, -1.0}, {1e-6, 0.011, 1.0}};
  const TetMesh mesh = bar_mesh(4, 2, 2);
  const Model resting(settings, mesh);
  settings.effects.pop_back();
  const Model bare(settings, mesh);
  Eigen::VectorXd shift = zero(bare);
  for (int i = 0; i < mesh.node_count(); ++i) shift[3 * i + 1] = 1.0;
  const double held = shift.dot(resting.stiffness(prior(resting)) * shift - bare.stiffness(prior(bare)) * shift) / 500.0;
  EXPECT_NEAR(held, 0.02 * 0.01, 1e-9);
  EXPECT_NE(refusal([] { held_area("level_with: clamp, "); }).find("foundation.level_with"), std::string::npos);
  EXPECT_NE(refusal([] { held_area("level_with: skin, "); }).find("a flat region"), std::string::npos);
}

TEST(Pressure, OnAPatchIsPressureTimesArea) {
  const TetMesh mesh = bar_mesh();
  Model model(box_settings({kInertia, kLinear, "pressure: {region: top, topic: /p, scale: 0.5}"}), mesh);
  model.loads().courses().at("/p")->add(0.0, one(0.0));
  model.loads().courses().at("/p")->add(1.0, one(800.0));
  const Eigen::VectorXd force = load(model, 0.25, zero(model));
  const Eigen::Vector3d expected(0.0, 0.0, -0.5 * 200.0 * 0.10 * 0.02);
  EXPECT_LT((resultant(force) - expected).norm(), 1e-13 * expected.norm());
  const Eigen::Vector3d arm(0.05, 0.01, 0.02);
  EXPECT_LT((moment(mesh, zero(model), force) - arm.cross(expected)).norm(), 1e-13 * expected.norm());
}

TEST(Pressure, FollowsTheSurfaceWhenTheStrainIsFinite) {
  const TetMesh mesh = bar_mesh();
  Model model(box_settings({kInertia, kFinite, "pressure: {region: top, topic: /p}"}), mesh);
  model.loads().courses().at("/p")->add(0.0, one(300.0));
  // Turned about y and stretched along the bar: the area is larger, the normal another one.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d deformation = turn * Eigen::Vector3d(1.5, 0.9, 0.8).asDiagonal();
  Eigen::VectorXd u = zero(model);
  for (int i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = deformation * mesh.nodes.col(i) - mesh.nodes.col(i);
  const Eigen::Vector3d expected = -300.0 * (1.5 * 0.10) * (0.9 * 0.02) * (turn * Eigen::Vector3d::UnitZ());
  EXPECT_LT((resultant(load(model, 0.0, u)) - expected).norm(), 1e-12 * expected.norm());
}

// Force at `time` along a bar whose fibres pull with that pulse, over the force at its peak.
double activation(const std::string& pulse, double time) {
  const TetMesh mesh = bar_mesh();
  Model model(
      box_settings({kInertia, kLinear, "active_contraction: {direction: [1, 0, 0], amplitude: 100, " + pulse + "}"}), mesh);
  Model held(box_settings({kInertia, kLinear, "active_contraction: {direction: [1, 0, 0], amplitude: 100, duration: 1}"}),
             mesh);
  const Eigen::VectorXd most = load(held, 0.5, zero(held));
  return load(model, time, zero(model)).dot(most) / most.squaredNorm();
}

TEST(ActiveContraction, IsAnArchUnlessToldOtherwise) {
  const std::string pulse = "period: 0.8, onset: 0.1, duration: 0.4";
  for (const double time : {0.15, 0.2, 0.3, 0.42, 0.95})
    EXPECT_NEAR(activation(pulse, time), std::pow(std::sin(M_PI * std::fmod(time - 0.1, 0.8) / 0.4), 2), 1e-9) << time;
  for (const double time : {0.05, 0.1, 0.5, 0.7, 0.9}) EXPECT_NEAR(activation(pulse, time), 0.0, 1e-9) << time;
}

TEST(ActiveContraction, RisesAndFallsAtRatesOfItsOwn) {
  const std::string pulse = "period: 0.8, onset: 0.1, duration: 0.4, peak: 0.25";
  EXPECT_NEAR(activation(pulse, 0.15), 0.5, 1e-9);  // half of the rise
  EXPECT_NEAR(activation(pulse, 0.2), 1.0, 1e-9);
  EXPECT_NEAR(activation(pulse, 0.35), 0.5, 1e-9);  // half of the fall
  EXPECT_NEAR(activation(pulse, 1.15), 0.5, 1e-9);  // of the next pulse
  EXPECT_NEAR(activation(pulse, 0.55), 0.0, 1e-9);
  EXPECT_NEAR(activation(pulse + ", sharpness: 4", 0.35), 0.25, 1e-9);
}

// The zero of a transducer acts as a pressure that never changes, with small and with finite strain.
TEST(PressureOffset, IsAPressureThatStays) {
  const TetMesh mesh = bar_mesh();
  for (const std::string& law : {kLinear, kFinite}) {
    Model measured(box_settings({kInertia, law, "pressure: {region: top, topic: /p}"}), mesh);
    measured.loads().courses().at("/p")->add(0.0, one(300.0));
    Model offset(box_settings({kInertia, law, "pressure_offset: {region: top, pressure: 300}"}), mesh);
    const Eigen::VectorXd u = 0.003 * Eigen::VectorXd::LinSpaced(zero(measured).size(), 0.0, 30.0).array().sin();
    const Eigen::VectorXd expected = load(measured, 0.5, u);
    EXPECT_GT(expected.norm(), 0.01);
    EXPECT_LT((load(offset, 0.5, u) - expected).norm(), 1e-12 * expected.norm());
  }
}

// The symmetric part of a follower's derivative is what the stiffness holds where the loaded surface has an edge.
TEST(Pressure, TangentOnAPatchIsTheSymmetricPart) {
  const TetMesh mesh = bar_mesh(2);
  Model model(box_settings({kInertia, kFinite, "pressure: {region: top, topic: /p}"}), mesh);
  model.loads().courses().at("/p")->add(0.0, one(300.0));
  const Model::Part& part = model.parts().back();
  const Eigen::VectorXd u = 0.01 * Eigen::VectorXd::LinSpaced(zero(model).size(), 0.0, 30.0).array().sin();
  const auto force = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd f = zero(model);
    part.effect->finite_strain()->add_finite_force({0.0, at, zero(model)}, part.parameters(prior(model)), f);
    return f;
  };
  Eigen::MatrixXd d(u.size(), u.size());
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    const Eigen::VectorXd h = 1e-6 * Eigen::VectorXd::Unit(u.size(), j);
    d.col(j) = -(force(u + h) - force(u - h)) / 2e-6;
  }
  SparseMatrix tangent = model.fem().pattern();
  part.effect->finite_strain()->add_finite_stiffness({0.0, u, zero(model)}, part.parameters(prior(model)), tangent);
  const Eigen::MatrixXd symmetric = 0.5 * (d + d.transpose());
  EXPECT_LT((Eigen::MatrixXd(tangent) - symmetric).norm(), 1e-8 * symmetric.norm());
  EXPECT_GT((d - symmetric).norm(), 1e-3 * symmetric.norm());
}

// A box with a hole of one cell in its middle.
TetMesh hollow_box() {
  TetMesh mesh = make_box_mesh({0.03, 0.03, 0.03}, 3, 3, 3, 1);
  Eigen::MatrixXi kept(4, mesh.tet_count());
  Eigen::Index count = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) centre += 0.25 * mesh.nodes.col(mesh.tets(k, t));
    if ((centre - Eigen::Vector3d::Constant(0.015)).cwiseAbs().maxCoeff() > 0.005) kept.col(count++) = mesh.tets.col(t);
  }
  mesh.tets = kept.leftCols(count);
  set_boundary_facets(mesh, "hollow box");
  elevate_to_quadratic(mesh);
  return mesh;
}

TEST(Pressure, InAClosedCavityHasNoResultant) {
  const TetMesh mesh = hollow_box();
  for (const std::string& law : {kLinear, kFinite}) {
    ModelSettings settings = box_settings({kInertia, law, "pressure: {region: cavity, topic: /p}"});
    settings.regions = {{"cavity", BoxShape{Eigen::Vector3d::Constant(0.009), Eigen::Vector3d::Constant(0.021)}}};
    Model model(settings, mesh);
    model.loads().courses().at("/p")->add(0.0, one(500.0));
    const Eigen::VectorXd u = 3e-4 * Eigen::VectorXd::LinSpaced(zero(model).size(), 0.0, 90.0).array().sin();
    const Eigen::VectorXd at = law == kFinite ? u : zero(model);
    const Eigen::VectorXd force = load(model, 0.0, at);
    const double face = 500.0 * 0.01 * 0.01;
    EXPECT_GT(force.cwiseAbs().sum(), 5.9 * face);  // it pushes on six faces
    EXPECT_LT(resultant(force).norm(), 1e-10 * face);
    EXPECT_LT(moment(mesh, at, force).norm(), 1e-10 * face);
    const Eigen::VectorXd outwards = Eigen::Map<const Eigen::VectorXd>(mesh.nodes.data(), mesh.nodes.size());
    EXPECT_GT(force.dot(outwards), 0.0);  // a pressure above zero widens the cavity
  }
}

}  // namespace
}  // namespace tissue_stiffness
