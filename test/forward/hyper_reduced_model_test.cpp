// Hyper-reduced runs against runs in full.
#include "forward/hyper_reduced_model.hpp"

#include <gtest/gtest.h>

#include "../box_model.hpp"
#include "forward/full_residual.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFrame = 1.0 / 30.0;
constexpr int kTraining = 8, kFrames = 16;  // frames

FullModel::Options with_steps() {
  FullModel::Options options;
  options.step = kFrame / 4.0;
  return options;
}

Eigen::VectorXd at_modulus(const Model& model, double value) {
  Eigen::VectorXd w = model.parameters().prior_mean();
  w[0] = model.parameters().free().front().to_coordinate(value);
  return model.parameters().theta(w);
}

FullMotions motions_of(const Model& model, const std::vector<double>& moduli) {
  FullMotions out{Eigen::MatrixXd(model.fem().dof_count(), 0), {}};
  for (const double modulus : moduli) {
    const auto run = FullModel(model, with_steps()).start(at_modulus(model, modulus), 0.0);
    for (int k = 1; k <= 4 * kTraining; ++k) {
      run->advance(0.25 * kFrame * k);
      out.add({run->displacement(), {at_modulus(model, modulus)}});
    }
  }
  return out;
}

HyperOptions options() {
  HyperOptions out;
  out.full = with_steps();
  return out;
}

struct Case {
  std::string name;
  std::vector<std::string> effects;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class HyperReduced : public testing::TestWithParam<Case> {
 protected:
  HyperReduced() : model_(box_settings(effects()), bar_mesh(6, 2, 2)) {
    for (const auto& [topic, course] : model_.loads().courses()) {
      course->add(0.0, Eigen::VectorXd::Zero(course->components()));
      course->add(0.3, 0.02 * Eigen::VectorXd::LinSpaced(course->components(), 1.0, 2.0));
      course->add(1.0, Eigen::VectorXd::Zero(course->components()));
    }
  }
  static std::vector<std::string> effects() {
    std::vector<std::string> list{"inertia: {density: 1000}", "fixed: {region: clamp}"};
    list.insert(list.end(), GetParam().effects.begin(), GetParam().effects.end());
    return list;
  }
  Model model_;
};

// The tip moves by a tenth to a third of the length, at a modulus between those of the training and for twice as long.
TEST_P(HyperReduced, MovesAsInFull) {
  const HyperReducedModel reduced(model_, motions_of(model_, {60e3, 75e3}), options());
  const Eigen::VectorXd theta = at_modulus(model_, 66e3);
  const auto full = FullModel(model_, with_steps()).start(theta, 0.0), run = reduced.start(theta, 0.0);
  double most = 0.0, off = 0.0;
  const int tip = model_.mesh().node_count() - 1;
  for (int k = 1; k <= kFrames; ++k) {
    full->advance(kFrame * k);
    run->advance(kFrame * k);
    const Eigen::VectorXd u = full->displacement();
    most = std::max(most, u.segment<3>(3 * tip).norm());
    off = std::max(off, (run->displacement() - u).segment<3>(3 * tip).norm());
  }
  EXPECT_GT(most, 0.01) << "the bar hardly moved";
  EXPECT_LT(off, 5e-3 * most);
  EXPECT_LT(reduced.basis().points.size(), 400U);
  for (const SampledPoint& point : reduced.basis().points) EXPECT_GT(point.weight, 0.0);
}

std::string elasticity(const std::string& law) {
  return "elasticity: {law: " + law + ", poisson_ratio: 0.45, young_modulus: {prior: 60e3, factor: 2}}";
}
const char* const kGravity = "gravity: {acceleration: [0.5, 1, -4]}";

INSTANTIATE_TEST_SUITE_P(
    Models, HyperReduced,
    testing::Values(
        Case{"neo_hookean", {elasticity("neo_hookean"), kGravity}},
        Case{"damped", {elasticity("neo_hookean"), kGravity, "mass_damping: {alpha: 1}", "viscous_damping: {beta: 4e-3}"}},
        Case{"half_finite",
             {elasticity("linear"), kGravity, "geometric_nonlinearity: {share: 0.5}", "viscous_damping: {beta: 4e-3}"}},
        Case{"pulled", {elasticity("neo_hookean"), "traction: {region: tip, topic: /push, scale: 2}"}},
        Case{"stiffening", {elasticity("neo_hookean"), kGravity, "strain_stiffening: {exponent: 5}"}},
        Case{"inclusion",
             {elasticity("neo_hookean"), kGravity, "viscous_damping: {beta: 4e-3}",
              "stiff_inclusion: {center: [0.03, 0.01, 0.01], radius: 0.015, excess: 3}"}},
        Case{"compressible",
             {elasticity("neo_hookean"), kGravity, "viscous_damping: {beta: 4e-3}", "compressibility: {shift: -0.1}"}},
        Case{"fibres",
             {elasticity("neo_hookean"), kGravity, "fibre_reinforcement: {direction: [1, 0.3, 0.2], modulus: 6e4}"}},
        Case{"pressed",
             {elasticity("neo_hookean"), "pressure: {region: top, topic: /p, scale: 1000}",
              "pressure_offset: {region: top, pressure: 20}"}},
        Case{"half_pressed",
             {elasticity("linear"), kGravity, "geometric_nonlinearity: {share: 0.5}",
              "pressure: {region: top, topic: /p, scale: 1000}"}},
        Case{"mooney_rivlin", {elasticity("neo_hookean"), kGravity, "mooney_rivlin: {share: 0.6}"}},
        Case{"ogden", {elasticity("neo_hookean"), kGravity, "ogden: {exponent: 12}"}},
        Case{"collagen",
             {elasticity("neo_hookean"), kGravity,
              "holzapfel_gasser_ogden: {direction: [1, 0.3, 0.2], stiffness: 2e4, exponent: 3, dispersion: 0.1}"}},
        Case{"two_tissues",
             {"elasticity: {law: neo_hookean, region: near, poisson_ratio: 0.45, young_modulus: {prior: 60e3, factor: 2}}",
              "elasticity: {law: neo_hookean, region: far, poisson_ratio: 0.4, young_modulus: 30e3}", kGravity}}),
    [](const auto& info) { return info.param.name; });

class HyperReducedBar : public testing::Test {
 protected:
  const Model model_{
      box_settings({"inertia: {density: 1000}", "fixed: {region: clamp}", elasticity("neo_hookean"), kGravity}),
      bar_mesh(4, 1, 1)};
  HyperReducedModel reduced_{model_, motions_of(model_, {60e3}), options()};
  const Eigen::VectorXd theta_ = at_modulus(model_, 60e3);
};

TEST_F(HyperReducedBar, ShowsOnlyTheNodesOfItsOutput) {
  const auto whole = reduced_.start(theta_, 0.0);
  whole->advance(0.1);
  const Eigen::VectorXd u = whole->output();
  EXPECT_EQ(u, whole->displacement());
  reduced_.restrict_output_to(std::vector<int>{3, 20});
  const auto some = reduced_.start_all({theta_, theta_}, 0.0);
  some->advance({0.1, 0.1});
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(u.size(), 2);
  some->outputs(out);
  for (int node = 0; node < model_.mesh().node_count(); ++node) {
    const Eigen::Vector3d wanted =
        node == 3 || node == 20 ? Eigen::Vector3d(u.segment<3>(3 * node)) : Eigen::Vector3d::Zero();
    EXPECT_LT((out.col(1).segment<3>(3 * node) - wanted).norm(), 1e-12) << node;
  }
  Eigen::VectorXd sum(u.size());
  some->combine(Eigen::Vector2d(0.25, 0.75), sum);
  EXPECT_LT((sum - u).norm(), 1e-12);
}

TEST_F(HyperReducedBar, GoesOnFromWhereAnotherRunIs) {
  const auto run = reduced_.start(theta_, 0.0);
  run->advance(0.1);
  const auto next = reduced_.resume(theta_, *run);
  run->advance(0.2);
  next->advance(0.2);
  EXPECT_LT((run->displacement() - next->displacement()).cwiseAbs().maxCoeff(),
            1e-3 * run->displacement().cwiseAbs().maxCoeff());
  EXPECT_GT(run->velocity().norm(), 0.0);
}

// The residual of the model in full shows a load that pulls where nothing pulled in the training.
TEST(FullResidual, GrowsWhereTheTrainingKnewNothing) {
  Model model(box_settings({"inertia: {density: 1000}", "fixed: {region: clamp}", elasticity("neo_hookean"),
                            "gravity: {acceleration: [0, 0, -4]}", "traction: {region: tip, topic: /push}"}),
              bar_mesh(4, 1, 1));
  Course& course = *model.loads().courses().at("/push");
  course.add(0.0, Eigen::VectorXd::Zero(6));
  const Eigen::VectorXd theta = at_modulus(model, 60e3);
  const HyperReducedModel reduced(model, motions_of(model, {60e3}), options());
  const FullResidual residual(model, theta);
  HyperReducedTrajectory run(reduced, theta, 0.0);
  double trained = 0.0, pulled = 0.0;
  for (int k = 1; k <= kTraining; ++k) {
    run.advance(kFrame * k);
    trained = std::max(trained, residual.of(run));
  }
  course.add(kFrame * kTraining, Eigen::VectorXd::Zero(6));
  Eigen::VectorXd sideways = Eigen::VectorXd::Zero(6);
  sideways[1] = 0.05;
  course.add(kFrame * (kTraining + 2), sideways);
  course.add(1.0, sideways);
  for (int k = kTraining + 1; k <= kTraining + 4; ++k) {
    run.advance(kFrame * k);
    pulled = std::max(pulled, residual.of(run));
  }
  EXPECT_GT(trained, 0.0);
  EXPECT_GT(pulled, 3.0 * trained);
}

TEST(HyperReducedModel, TellsWhatItCannotStandFor) {
  const auto why = [](const std::vector<std::string>& more) {
    std::vector<std::string> list{"inertia: {density: 1000}", "fixed: {region: clamp}", kGravity};
    list.insert(list.end(), more.begin(), more.end());
    return why_not_hyper_reduced(Model(box_settings(list), bar_mesh(2)));
  };
  EXPECT_EQ(why({elasticity("neo_hookean")}), "");
  EXPECT_EQ(why({elasticity("linear")}), "no law of finite strain");
  for (const char* effect : {"contact_plane: {point: [0, 0, -0.01], normal: [0, 0, 1]}",
                             "viscoelasticity: {gamma: 0.3, tau: 0.05}", "initial_motion: {equilibrium: 0.5}"}) {
    EXPECT_NE(why({elasticity("neo_hookean"), effect}), "") << effect;
  }
}

TEST(QuadraticForce, IsThePolynomialItWasMadeFrom) {
  Eigen::MatrixXd linear(3, 3), first(3, 3), second(3, 3);
  linear << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  first << 2, -1, 0, 1, 3, 1, 0, 2, 1;
  second << 1, 1, -2, 0, 1, 1, 3, 0, -1;
  const auto polynomial = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
    return Eigen::Vector3d(0.5, -1.0, 2.0) + linear * q + (first * q).cwiseProduct(second * q);
  };
  const QuadraticForce force(polynomial, Eigen::Vector3d(1e-2, 1.0, 30.0));
  const Eigen::Vector3d q(0.3, -2.0, 5.0);
  Eigen::VectorXd out = Eigen::Vector3d::Ones();
  force.add_force(2.0, q, out);
  EXPECT_LT((out - Eigen::Vector3d::Ones() - 2.0 * polynomial(q)).norm(), 1e-8);
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(3, 3), slopes(3, 3);
  force.add_stiffness(2.0, q, tangent);
  for (int j = 0; j < 3; ++j) {
    const Eigen::Vector3d step = 1e-4 * Eigen::Vector3d::Unit(j);
    slopes.col(j) = (polynomial(q + step) - polynomial(q - step)) / 2e-4;
  }
  EXPECT_LT((tangent + slopes + slopes.transpose()).norm(), 1e-6 * slopes.norm());
}

// Fibres damp through their linear stiffness, which has no form at points.
TEST(HyperReducedModel, IsRefusedForFibresThatDamp) {
  const auto why = [](const std::string& law, const std::string& damping) {
    return why_not_hyper_reduced(Model(box_settings({"inertia: {density: 1000}", "fixed: {region: clamp}", elasticity(law),
                                                     "fibre_reinforcement: {direction: [1, 0, 0], modulus: 1e4}", damping}),
                                       bar_mesh(2)));
  };
  EXPECT_EQ(why("neo_hookean", "mass_damping: {alpha: 1}"), "");
  EXPECT_NE(why("neo_hookean", "viscous_damping: {beta: 4e-3}"), "");
  EXPECT_NE(why("linear", "geometric_nonlinearity: {share: 0.5}"), "") << "a part of the fibres is at small strain";
}

TEST(FullMotions, AreThinnedEvenly) {
  FullMotions all{Eigen::MatrixXd(3, 0), {}};
  for (int k = 0; k < 10; ++k) all.add({Eigen::Vector3d::Constant(k), {Eigen::VectorXd::Constant(1, k)}});
  const FullMotions few = all.thinned(2);
  ASSERT_EQ(few.displacements.cols(), 2);
  EXPECT_EQ(few.displacements(0, 0), 2.0);
  EXPECT_EQ(few.displacements(0, 1), 7.0);
  EXPECT_EQ(few.thetas[1][0], 7.0);
  EXPECT_EQ(all.thinned(10).displacements.cols(), 10);
}

}  // namespace
}  // namespace tissue_stiffness
