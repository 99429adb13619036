// A linear body in contact, in modes and static responses: against the same model integrated in full.
#include "forward/contact_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "../block_model.hpp"
#include "../box_model.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

const std::string kBall = "center: [0, 0, 0], radius: 0.01";

ModelSettings settings(const std::vector<std::string>& more, const std::string& modulus = "2.0e4") {
  std::vector<std::string> effects{"elasticity: {law: linear, young_modulus: " + modulus + ", poisson_ratio: 0.4}"};
  effects.insert(effects.end(), more.begin(), more.end());
  return block_settings(effects);
}

// The ball comes down on the block, moves along it, and leaves again.
void drive(Model& model) {
  model.loads().set_first_stamp(0.0);
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.01 * k, deep = 0.0015 * std::sin(M_PI * std::min(1.0, t / 0.8));
    model.loads().courses().at("/pose")->add(
        t, pose_values(Eigen::Isometry3d(Eigen::Translation3d(0.006 + 0.008 * t, 0.01, 0.0302 - deep))));
  }
}

Eigen::VectorXd prior(const Model& model) {
  return model.parameters().theta(model.parameters().prior_mean());
}

struct Difference {
  double displacement, force;  // rms over the run, relative
};

Difference compare(const ModelSettings& settings, double end = 0.6) {
  Model model(settings, block_mesh(4));
  drive(model);
  EXPECT_TRUE(ContactModel::suits(model));
  FullModel::Options options;
  options.step = 0.001;
  options.spectral_radius = 0.9;
  const auto full = FullModel(model, options).start(prior(model), 0.0);
  const ContactModel contact(model, BasisOptions());
  const auto run = contact.start(prior(model), 0.0);
  double motion = 0.0, motion_off = 0.0, force = 0.0, force_off = 0.0;
  for (double t = 0.02; t < end; t += 0.02) {
    full->advance(t);
    run->advance(t);
    const Eigen::VectorXd a = full->output(), b = run->output();
    motion += a.head(a.size() - 3).squaredNorm();
    motion_off += (a - b).head(a.size() - 3).squaredNorm();
    force += a.tail<3>().squaredNorm();
    force_off += (a - b).tail<3>().squaredNorm();
  }
  EXPECT_GT(force, 0.0);
  const Difference out{std::sqrt(motion_off / motion), std::sqrt(force_off / force)};
  std::printf("contact: displacement %.1e, force %.1e of the full model's\n", out.displacement, out.force);
  return out;
}

void expect_same(const std::vector<std::string>& effects) {
  const Difference found = compare(settings(effects));
  EXPECT_LT(found.displacement, 0.01) << effects.back();
  EXPECT_LT(found.force, 0.01) << effects.back();
}

TEST(ContactModel, FollowsTheFullModelWhereABallMovesOverADampedBar) {
  expect_same({"viscous_damping: {beta: 0.01}", touching(kBall)});
}

// A slow tool needs few steps: frames that are 100 ms apart have the forces of frames that are 10 ms apart.
TEST(ContactModel, TakesAsManyStepsAsASlowToolNeeds) {
  Model model(settings({"viscous_damping: {beta: 0.01}", touching(kBall)}), block_mesh(4));
  model.loads().set_first_stamp(0.0);
  for (int k = 0; k <= 300; ++k) {
    const double t = 0.01 * k, deep = 0.0015 * (1.0 - std::cos(2.0 * M_PI * t / 3.0)) / 2.0;
    model.loads().courses().at("/pose")->add(
        t, pose_values(Eigen::Isometry3d(Eigen::Translation3d(0.01, 0.01, 0.0302 - deep))));
  }
  const ContactModel contact(model, BasisOptions());
  const auto often = contact.start(prior(model), 0.0), seldom = contact.start(prior(model), 0.0);
  double force = 0.0, off = 0.0;
  for (int k = 1; k <= 280; ++k) {
    often->advance(0.01 * k);
    if (k % 10 != 0) continue;
    seldom->advance(0.01 * k);
    force += often->output().tail<3>().squaredNorm();
    off += (often->output() - seldom->output()).tail<3>().squaredNorm();
  }
  EXPECT_GT(force, 0.0);
  EXPECT_LT(std::sqrt(off / force), 1e-3);
}

TEST(ContactModel, RelaxesAsTheFullModelDoes) {
  expect_same({"viscous_damping: {beta: 0.002}", "viscoelasticity: {gamma: 0.8, tau: 0.2}", touching(kBall)});
}

TEST(ContactModel, RubsAsTheFullModelDoes) {
  expect_same({"viscous_damping: {beta: 0.01}", touching(kBall + ", friction: 0.4")});
}

TEST(ContactModel, AddsTheOtherLoads) {
  expect_same({"viscous_damping: {beta: 0.01}", "gravity: {acceleration: [0, 0, -3]}", "mass_damping: {alpha: 5}",
               touching(kBall)});
}

// A run goes on where another one was, with the same parameters as if nothing had happened.
TEST(ContactModel, ResumesWhereItWas) {
  Model model(settings({"viscous_damping: {beta: 0.01}", "viscoelasticity: {gamma: 0.5, tau: 0.1}", touching(kBall)}),
              block_mesh());
  drive(model);
  const ContactModel contact(model, BasisOptions());
  const auto whole = contact.start(prior(model), 0.0), first = contact.start(prior(model), 0.0);
  whole->advance(0.2);
  first->advance(0.2);
  const auto second = contact.resume(prior(model), *first);
  whole->advance(0.3);
  second->advance(0.3);
  EXPECT_LT((whole->output() - second->output()).norm(), 1e-6 * whole->output().norm());
}

// A ball that is deep inside the tissue at once: the exact tangent is indefinite there. Where nothing relaxes, a slow body
// comes to the same place as in many steps.
TEST(ContactModel, SettlesWhereAToolIsDeepAtOnce) {
  Model model(settings({"mass_damping: {alpha: 200}", touching(kBall)}), block_mesh(6));
  model.loads().set_first_stamp(0.0);
  for (int k = 0; k <= 200; ++k) {
    const double t = 0.01 * k, deep = 0.004 * std::min(1.0, std::max(0.0, t - 0.5) / 0.02);
    model.loads().courses().at("/pose")->add(t,
                                             pose_values(Eigen::Isometry3d(Eigen::Translation3d(0.01, 0.01, 0.03 - deep))));
  }
  const ContactModel contact(model, BasisOptions());
  const auto at_once = contact.start(prior(model), 0.0), slowly = contact.start(prior(model), 0.0);
  at_once->advance(0.6);
  for (int k = 1; k <= 300; ++k) slowly->advance(0.002 * k);
  for (const auto* run : {&at_once, &slowly}) (*run)->advance(1.9);
  EXPECT_GT(slowly->output().tail<3>().norm(), 0.1);
  EXPECT_LT((at_once->output() - slowly->output()).norm(), 1e-3 * slowly->output().norm());
}

// Sensors of forces need no motion of the body, and those of some points only theirs. The surface is shown all the same.
TEST(ContactModel, RestrictsTheOutputAndNotTheDisplacement) {
  Model model(settings({"viscous_damping: {beta: 0.01}", touching(kBall)}), block_mesh());
  drive(model);
  ContactModel contact(model, BasisOptions());
  const auto all = contact.start(prior(model), 0.0);
  all->advance(0.3);
  const Eigen::VectorXd expected = all->output();
  const Eigen::Index dofs = expected.size() - 3;
  for (const OutputNodes& nodes : {OutputNodes(std::vector<int>()), OutputNodes({3, 7})}) {
    contact.restrict_output_to(nodes);
    const auto run = contact.start(prior(model), 0.0);
    run->advance(0.3);
    const Eigen::VectorXd output = run->output();
    EXPECT_LT((run->displacement() - expected.head(dofs)).norm(), 1e-12 * expected.head(dofs).norm());
    EXPECT_LT((output.tail<3>() - expected.tail<3>()).norm(), 1e-12 * expected.tail<3>().norm());
    EXPECT_EQ(output.head(dofs).isZero(0.0), nodes->empty());
    for (const int node : *nodes) EXPECT_LT((output - expected).segment<3>(3 * node).norm(), 1e-12 * expected.norm());
  }
}

// Sigma points of a model with one modulus share its static response.
TEST(ContactModel, AStifferBodyOnlyScalesTheResponse) {
  Model model(settings({touching(kBall)}, "{prior: 2.0e4, factor: 2}"), block_mesh());
  drive(model);
  const ContactModel contact(model, BasisOptions());
  const auto one = contact.flexibility(model.parameters().theta(Eigen::VectorXd::Constant(1, std::log(2e4)))),
             other = contact.flexibility(model.parameters().theta(Eigen::VectorXd::Constant(1, std::log(5e4))));
  EXPECT_EQ(one.unit, other.unit);
  EXPECT_NEAR(other.ratio / one.ratio, 2.5, 1e-9);
}

TEST(ContactModel, SuitsOnlyHeldBodiesOfSmallStrain) {
  const auto suits = [](const std::vector<std::string>& effects, const std::string& law) {
    std::vector<std::string> all{"inertia: {density: 1000}",
                                 "elasticity: {law: " + law + ", young_modulus: 2.0e4, poisson_ratio: 0.4}"};
    all.insert(all.end(), effects.begin(), effects.end());
    return ContactModel::suits(Model(box_settings(all), bar_mesh(2)));
  };
  const std::string held = "fixed: {region: clamp}", touched = touching(kBall);
  EXPECT_TRUE(suits({held, touched}, "linear"));
  EXPECT_FALSE(suits({touched}, "linear"));
  EXPECT_FALSE(suits({held, touched}, "neo_hookean"));
  EXPECT_FALSE(suits({held, touched, "geometric_nonlinearity: {}"}, "linear"));
  EXPECT_FALSE(suits({held}, "linear"));
}

}  // namespace
}  // namespace tissue_stiffness
