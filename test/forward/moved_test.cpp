// A region follows a pose, and the force that this takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../box_model.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"
#include "full_against_reduced.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kModulus = 3e4, kArea = 4e-4, kLength = 0.1;
const std::string kMoved = "moved: {region: tip, topic: /pose, smoothing: 0}";

std::vector<std::string> bar(const std::vector<std::string>& more, double ratio = 0.0, const std::string& law = "linear") {
  std::vector<std::string> effects{"inertia: {density: 1000}", "elasticity: {law: " + law + ", young_modulus: 3.0e4, " +
                                                                   "poisson_ratio: " + std::to_string(ratio) + "}"};
  effects.insert(effects.end(), more.begin(), more.end());
  return effects;
}

// A pose in every millisecond that `motion` gives: displacement [m] and turn about z [rad] at a time after rest.
template <typename Motion>
void drive(Model& model, const Motion& motion, double rest = 0.0) {
  model.loads().set_rest(rest);
  model.loads().set_first_stamp(0.0);
  for (int k = 0; k <= 1000; ++k) {
    const Eigen::Vector4d now = motion(std::max(0.0, 1e-3 * k - rest));
    const Eigen::AngleAxisd turn(now[3], Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d tool(0.3, 0.1, -0.2);  // anywhere: the motion counts from rest
    const Eigen::Isometry3d pose = Eigen::Translation3d(turn * tool + now.head<3>()) * turn;
    model.loads().courses().at("/pose")->add(1e-3 * k, pose_values(pose));
  }
}

// Along x by `way` within 0.2 s, without a jolt.
auto stretch(double way) {
  return [way](double t) {
    const double s = std::min(t / 0.2, 1.0);
    return Eigen::Vector4d(way * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 0.0, 0.0, 0.0);
  };
}

Eigen::VectorXd theta(const Model& model) {
  return model.parameters().theta(model.parameters().prior_mean());
}

// The forces at a time, with both models, in steps of 2 ms.
struct Forces {
  Eigen::Vector3d full, reduced;
};
Forces forces(const Model& model, double time) {
  FullModel::Options options;
  options.step = 0.001;
  options.spectral_radius = 1.0;
  const FullModel full(model, options);
  const ReducedModel reduced(model);
  const auto a = full.start(theta(model), 0.0), b = reduced.start(theta(model), 0.0);
  for (int k = 1; k <= std::lround(time / 0.002); ++k) {
    a->advance(0.002 * k);
    b->advance(0.002 * k);
  }
  return {a->output().tail<3>(), b->output().tail<3>()};
}

TEST(Moved, ABarThatIsStretchedPullsBack) {
  Model model(box_settings(bar({"fixed: {region: clamp}", kMoved, "mass_damping: {alpha: 60}"})), bar_mesh());
  drive(model, stretch(0.002));
  ASSERT_EQ(model.output_size(), model.fem().dof_count() + 3);
  const Forces found = forces(model, 0.9);
  const double expected = kModulus * kArea * 0.002 / kLength;
  EXPECT_NEAR(found.full.x(), expected, 1e-3 * expected);
  EXPECT_NEAR(found.reduced.x(), expected, 1e-3 * expected);
  EXPECT_LT(found.full.tail<2>().norm(), 1e-3 * expected);
}

// The force of a standard linear solid after a stretch relaxes from 1 + gamma to 1: held since 0.2 s.
TEST(Moved, TheForceOfAViscoelasticBarRelaxes) {
  Model model(box_settings(bar({"fixed: {region: clamp}", kMoved, "viscous_damping: {beta: 0.004}",
                                "viscoelasticity: {gamma: 0.5, tau: 0.3}"})),
              bar_mesh());
  drive(model, stretch(0.002));
  double z = 0.0;
  const auto way = stretch(0.002);
  for (int k = 0; k < 40000; ++k) z += 1e-5 / 0.3 * (way(1e-5 * k)[0] - z);  // until 0.4 s
  const double expected = kModulus * kArea / kLength * (0.002 + 0.5 * (0.002 - z));
  EXPECT_GT(expected, 1.1 * kModulus * kArea / kLength * 0.002);
  const Forces found = forces(model, 0.4);
  EXPECT_NEAR(found.full.x(), expected, 3e-3 * expected);
  EXPECT_NEAR(found.reduced.x(), expected, 3e-3 * expected);
}

// While it is stretched at a constant rate, a Kelvin-Voigt bar adds beta times the rate.
TEST(Moved, TheForceOfADampedBarHoldsItsRate) {
  Model model(box_settings(bar({"fixed: {region: clamp}", kMoved, "viscous_damping: {beta: 0.05}"})), bar_mesh());
  drive(model, [](double t) { return Eigen::Vector4d(0.004 * t, 0.0, 0.0, 0.0); });
  const double expected = kModulus * kArea / kLength * (0.004 * 0.8 + 0.05 * 0.004);
  const Forces found = forces(model, 0.8);
  EXPECT_NEAR(found.full.x(), expected, 3e-3 * expected);
  EXPECT_NEAR(found.reduced.x(), expected, 3e-3 * expected);
}

// Nothing else holds the body: the base that carries it accelerates its mass.
TEST(Moved, ABaseThatAcceleratesCarriesTheMass) {
  Model model(box_settings(bar({"moved: {region: clamp, topic: /pose, smoothing: 0}", "mass_damping: {alpha: 0.0}",
                                "viscous_damping: {beta: 0.15}"},
                               0.4)),
              bar_mesh());
  drive(model, [](double t) { return Eigen::Vector4d(0.0, 0.5 * 0.3 * t * t, 0.0, 0.0); });
  const Forces found = forces(model, 0.9);
  const double expected = 1000.0 * kArea * kLength * 0.3;
  EXPECT_NEAR(found.full.y(), expected, 0.02 * expected);
  EXPECT_NEAR(found.reduced.y(), expected, 0.02 * expected);
}

TEST(Moved, TheReducedModelFollowsTheFullOne) {
  Model model(box_settings(bar({"fixed: {region: clamp}", kMoved, "gravity: {acceleration: [0, 0, -2]}",
                                "viscoelasticity: {gamma: 0.4, tau: 0.05}", "viscous_damping: {beta: 0.004}"},
                               0.4)),
              bar_mesh());
  const auto motion = [](double t) {
    const double a = std::pow(std::sin(10.0 * t), 2), b = std::pow(std::sin(6.0 * t), 2);
    return Eigen::Vector4d(0.001 * b, 0.004 * a, -0.003 * b, 0.08 * (b - a));
  };
  drive(model, motion, 0.1);
  const ReducedModel reduced(model);
  const double apart = full_against_reduced(model, reduced, theta(model), 0.001);
  std::printf("reduced against full: %.1e\n", apart);
  EXPECT_LT(apart, 2e-3);
  drive(model, motion);
  const Forces found = forces(model, 0.5);
  EXPECT_LT((found.full - found.reduced).norm(), 0.03 * found.full.norm());
}

// A body of finite strain whose only support turns by a quarter turns with it, and does not feel it.
TEST(Moved, ABodyTurnsWithItsSupport) {
  Model model(box_settings(bar({"moved: {region: clamp, topic: /pose, smoothing: 0}", "mass_damping: {alpha: 20}"}, 0.4,
                               "neo_hookean")),
              bar_mesh(2));
  drive(model, [](double t) {
    const double s = std::min(t / 0.6, 1.0);
    return Eigen::Vector4d(0.0, 0.0, 0.0, 0.5 * M_PI * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s));
  });
  const FullModel full(model, {});
  const auto run = full.start(theta(model), 0.0);
  for (int k = 1; k <= 100; ++k) run->advance(0.01 * k);
  const Eigen::VectorXd u = run->displacement();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int node = 0; node < model.mesh().node_count(); ++node) {
    const Eigen::Vector3d x = model.mesh().nodes.col(node);
    EXPECT_LT((x + u.segment<3>(3 * node) - turn * x).norm(), 1e-3) << node;
  }
  EXPECT_LT(run->output().tail<3>().norm(), 0.02);
}

// Where the motion is given, the shape does not depend on the modulus, and the force is in proportion to it.
TEST(Moved, TheForceIsInProportionToTheModulus) {
  const auto settings = [](const std::string& modulus) {
    return box_settings({"inertia: {density: 1}",
                         "elasticity: {law: linear, young_modulus: " + modulus + ", poisson_ratio: 0.4}",
                         "fixed: {region: clamp}", kMoved, "viscous_damping: {beta: 0.01}"});
  };
  Model soft(settings("1.0e4"), bar_mesh()), stiff(settings("3.0e4"), bar_mesh());
  drive(soft, stretch(0.002));
  drive(stiff, stretch(0.002));
  const Forces a = forces(soft, 0.5), b = forces(stiff, 0.5);
  EXPECT_LT((3.0 * a.reduced - b.reduced).norm(), 1e-3 * b.reduced.norm());
}

}  // namespace
}  // namespace tissue_stiffness
