// The reduced model against the full one and against closed forms.
#include "forward/reduced_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <set>

#include "../box_model.hpp"
#include "../static_sag.hpp"
#include "fem/sparse_solver.hpp"
#include "forward/first_order_model.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_trajectory.hpp"
#include "full_against_reduced.hpp"
#include "meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

const std::string kInertia = "inertia: {density: 1000}";
const std::string kFixed = "fixed: {region: clamp}";
const std::string kGravity = "gravity: {acceleration: [0.5, 1, -2]}";

std::string elastic(const std::string& modulus, const std::string& region = "") {
  return "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + modulus +
         (region.empty() ? "}" : ", region: " + region + "}");
}

Eigen::VectorXd prior(const Model& model) {
  return model.parameters().theta(model.parameters().prior_mean());
}

double difference(const Model& model, const Eigen::VectorXd& theta, double step) {
  return full_against_reduced(model, ReducedModel(model), theta, step);
}

// A push on the tip and a pressure on the top, both sampled at instants of their own.
void push(Model& model) {
  for (int k = 0; k < 60; ++k) {
    const double t = 0.1 + 0.008 * k;
    Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
    wrench.head<3>() << 2e-3 * std::sin(20.0 * t), 0.0, 4e-3 * std::cos(9.0 * t);
    model.loads().courses().at("/wrench")->add(t, wrench);
    if (model.loads().courses().count("/pressure") == 0) continue;
    model.loads().courses().at("/pressure")->add(t, Eigen::VectorXd::Constant(1, 5.0 * std::sin(14.0 * t)));
  }
}

TEST(ReducedModel, FollowsTheFullOneUnderLoads) {
  const TetMesh mesh = bar_mesh(5);
  Model model(box_settings({kInertia, elastic("{prior: 3.0e4, factor: 2}"), kFixed, kGravity, "mass_damping: {alpha: 1}",
                            "viscous_damping: {beta: 2.0e-3}", "traction: {region: tip, topic: /wrench}",
                            "pressure: {region: top, topic: /pressure}", "added_mass: {region: tip, mass: 0.005}"}),
              mesh);
  push(model);
  const double at_prior = difference(model, prior(model), 2e-4);
  const double away =
      difference(model, model.parameters().theta(model.parameters().prior_mean().array() + std::log(1.9)), 2e-4);
  std::printf("reduced against full, loaded bar: %.1e, E 1.9x: %.1e of the motion\n", at_prior, away);
  EXPECT_LT(at_prior, 1e-3);
  EXPECT_LT(away, 1e-3);
}

// An effect that is absent at the prior leaves the root alone, another modulus changes nothing but a factor; another load
// or another body is another root.
TEST(ReducedModel, TakesOverARelativesRootOnlyWhereItIsItsOwn) {
  const TetMesh mesh = bar_mesh(5);
  const std::string modulus = elastic("{prior: 3.0e4, factor: 2}");
  const std::vector<std::vector<std::string>> lists = {
      {kInertia, modulus, kFixed, kGravity, "foundation: {region: top, stiffness: {mean: 0, std: 1.0e4}}"},
      {kInertia, modulus, kFixed, kGravity, "foundation: {region: top, stiffness: 1.0e4}"},
      {kInertia, modulus, kFixed, "gravity: {acceleration: [3, 0, -1]}"}};
  const Model base(box_settings({kInertia, modulus, kFixed, kGravity}), mesh);
  BasisOptions options;
  options.keep_root = true;
  const ReducedModel relative(base, options);
  for (const std::vector<std::string>& effects : lists) {
    const Model model(box_settings(effects), mesh);
    const ReducedModel alone(model, options), beside(model, options, &relative);
    EXPECT_EQ(alone.basis(), beside.basis()) << effects[1] << effects.back();
  }
  const Model more(box_settings(lists.front()), mesh), other(box_settings(lists.back()), mesh);
  const Model harder(box_settings({kInertia, elastic("{prior: 4.0e4, factor: 2}"), kFixed, kGravity}), mesh);
  const auto root = build_reduced_basis(base, options).root;
  EXPECT_EQ(build_reduced_basis(more, options, root).root, root);
  EXPECT_EQ(build_reduced_basis(harder, options, root).root, root);
  EXPECT_NE(build_reduced_basis(other, options, root).root, root);
  const Model reused(harder.settings(), base);
  const Eigen::VectorXd alone = ReducedModel(harder).modes(prior(harder))->square;
  const Eigen::VectorXd beside = ReducedModel(reused, options, &relative).modes(prior(reused))->square;
  EXPECT_LT(((alone - beside).array() / alone.array()).head(20).abs().maxCoeff(), 1e-6);
}

TEST(Model, SharesWithARelativeWhatBothHaveOfTheBody) {
  const auto model_of = [](const std::string& density, const std::string& ratio) {
    return box_settings({"inertia: {density: " + density + "}", elastic("{prior: 3.0e4, factor: 2}", "near"),
                         "elasticity: {law: linear, region: far, young_modulus: 1.0e4, poisson_ratio: " + ratio + "}",
                         kFixed, kGravity});
  };
  const Model base(model_of("1000", "0.4"), bar_mesh());
  const Model lighter(model_of("900", "0.4"), base), other(model_of("1000", "0.3"), base);
  const auto matrix = [](const Model& model, std::size_t part) {
    const LinearTerms& terms = model.parts()[part].terms;
    return (part == 0 ? terms.mass : terms.stiffness).front().matrix;
  };
  EXPECT_EQ(&lighter.fem(), &base.fem());
  EXPECT_NE(matrix(lighter, 0), matrix(base, 0));
  EXPECT_EQ(matrix(other, 0), matrix(base, 0));
  EXPECT_EQ(matrix(lighter, 2), matrix(base, 2));
  EXPECT_NE(matrix(other, 2), matrix(base, 2));
  for (const Model* model : {&lighter, &other}) {
    const Model alone(model->settings(), bar_mesh());
    const Eigen::VectorXd theta = prior(alone);
    EXPECT_EQ((alone.mass(theta) - model->mass(theta)).norm(), 0.0);
    EXPECT_EQ((alone.stiffness(theta) - model->stiffness(theta)).norm(), 0.0);
    EXPECT_EQ(alone.fixed(theta), model->fixed(theta));
  }
}

// What was absent there acts here, in another place of the list; of a support that is missing here nothing is left.
TEST(ReducedModel, AdoptsTheVectorsOfARelativeThatHeldItsEffects) {
  const TetMesh mesh = bar_mesh(5);
  const std::string modulus = elastic("{prior: 3.0e4, factor: 2}"), wrench = "traction: {region: tip, topic: /wrench}";
  const Model wide(box_settings({kInertia, modulus, kFixed, wrench, "mass_damping: {alpha: {mean: 0, std: 1}}",
                                 "elastic_support: {region: clamp, compliance: {mean: 0, std: 1.0e-7}}",
                                 "gravity: {acceleration: {mean: [0, 0, 0], std: 3}}"}),
                   mesh);
  Model narrow(box_settings({kInertia, modulus, "gravity: {acceleration: [0.5, 1, -2]}", kFixed, wrench,
                             "mass_damping: {alpha: 1}", "pressure: {region: top, topic: /pressure}"}),
               mesh);
  push(narrow);
  const ReducedModel relative(wide);
  BasisOptions options;
  options.adopt = true;
  const ReducedModel reduced(narrow, options, &relative);
  const Eigen::Index kept = reduced.basis().cols();
  EXPECT_EQ(relative.basis().cols() - kept, options.released);
  EXPECT_EQ(reduced.basis(), relative.basis().leftCols(kept));
  const double off = full_against_reduced(narrow, reduced, prior(narrow), 2e-4);
  std::printf("in a relative's vectors: %.1e of the motion\n", off);
  EXPECT_LT(off, 1e-3);
  EXPECT_EQ(ReducedModel(wide, options, &relative).basis(), relative.basis());
}

// Terms that are others here are projected anew, whatever the label: modes are those of this model's mass and stiffness.
TEST(ReducedModel, AdoptsTheProjectionsOfEqualTermsAlone) {
  const TetMesh mesh = bar_mesh(4);
  const auto settings = [](const std::string& region, const std::string& ratio, const std::string& x) {
    return box_settings({kInertia, "elasticity: {law: linear, poisson_ratio: " + ratio + ", young_modulus: 3.0e4}",
                         "added_mass: {region: " + region + ", mass: 0.01}", kFixed, kGravity,
                         "stiff_inclusion: {center: [" + x + ", 0.01, 0.01], radius: 0.012, excess: 1}"});
  };
  const Model same(settings("tip", "0.45", "0.03"), mesh);
  const ReducedModel relative(same);
  const auto known = relative.modes(prior(same));
  BasisOptions options;
  options.adopt = true;
  for (const auto& [region, ratio, x] : std::vector<std::array<std::string, 3>>{
           {"tip", "0.45", "0.03"}, {"tip", "0.45", "0.05"}, {"tip", "0.3", "0.03"}, {"top", "0.45", "0.03"}}) {
    const Model model(settings(region, ratio, x), mesh);
    const ReducedModel reduced(model, options, &relative);
    ASSERT_EQ(reduced.basis(), relative.basis());
    const auto modes = reduced.modes(prior(model));
    EXPECT_EQ(modes->square == known->square, region == "tip" && ratio == "0.45" && x == "0.03");
    const Eigen::MatrixXd shapes = reduced.basis() * modes->shapes, square = modes->square.asDiagonal();
    const Eigen::MatrixXd mass = shapes.transpose() * (model.mass(prior(model)) * shapes);
    const Eigen::MatrixXd stiffness = shapes.transpose() * (model.stiffness(prior(model)) * shapes);
    EXPECT_LT((mass - Eigen::MatrixXd::Identity(mass.rows(), mass.cols())).norm(), 1e-8) << region << ratio << x;
    EXPECT_LT((stiffness - square).norm(), 1e-8 * square.norm()) << region << ratio << x;
  }
}

TEST(ReducedModel, FollowsTheFullOneWithSeveralModuli) {
  const TetMesh mesh = bar_mesh(4);
  const Model model(box_settings({kInertia, elastic("{prior: 3.0e4, factor: 2}", "near"),
                                  elastic("{prior: 3.0e4, factor: 2}", "far"), kFixed, kGravity}),
                    mesh);
  for (const auto& [near, far] : std::vector<std::pair<double, double>>{{1.0, 1.0}, {2.0, 0.5}, {0.6, 2.5}}) {
    const Eigen::Vector2d w(std::log(3e4 * near), std::log(3e4 * far));
    const double error = difference(model, model.parameters().theta(w), 1e-4);
    std::printf("reduced against full, moduli %.1fx and %.1fx: %.1e of the motion\n", near, far, error);
    EXPECT_LT(error, 2e-3);
  }
}

TEST(ReducedModel, FollowsTheFullOneFromAnInitialVelocity) {
  const TetMesh mesh = bar_mesh(4);
  const Model model(box_settings({kInertia, elastic("3.0e4"), kFixed, "viscous_damping: {beta: 4.0e-3}"},
                                 "[{vertices: {topic: /v, noise: 1.0e-4}}]", "initial: {velocity: [0, 0, -0.2]}"),
                    mesh);
  // A jump of the velocity at the clamp excites every mode: the surface follows less closely than under smooth loads.
  EXPECT_LT(difference(model, prior(model), 1e-4), 5e-3);
}

// One vector, the static sag x: u(t) = x (1 - e^-st (cos wt + s/w sin wt)).
void expect_one_mode(const Model& model) {
  const Eigen::VectorXd x = static_sag(model);
  const double square = x.dot(model.stiffness(prior(model)) * x) / x.dot(model.mass(prior(model)) * x);
  const double s = 0.5 * (model.mass_damping(prior(model)) + model.stiffness_damping(prior(model)) * square),
               w = std::sqrt(square - s * s);
  const ReducedModel reduced(model, {1});
  ASSERT_EQ(reduced.basis().cols(), 1);
  const auto run = reduced.start(prior(model), 0.0);
  for (const double t : {0.003, 0.05, 0.31, 0.8, 3.0}) {
    run->advance(t);
    const double part = 1.0 - std::exp(-s * t) * (std::cos(w * t) + s / w * std::sin(w * t));
    const double speed = std::exp(-s * t) * (w + s * s / w) * std::sin(w * t);
    EXPECT_LT((run->displacement() - part * x).norm(), 1e-9 * x.norm()) << t;
    EXPECT_LT((run->velocity() - speed * x).norm(), 1e-9 * std::sqrt(square) * x.norm()) << t;
  }
}

TEST(ReducedModel, OneModeIsTheClosedForm) {
  const TetMesh mesh = bar_mesh(3);
  Model model(box_settings({kInertia, elastic("3.0e4"), kFixed, "traction: {region: tip, topic: /wrench}",
                            "mass_damping: {alpha: 2}", "viscous_damping: {beta: 0.01}"}),
              mesh);
  Eigen::VectorXd wrench(6);
  wrench << 0.02, 0, 0, 0, 0, 0;  // along x: the basis begins with this component's response
  model.loads().courses().at("/wrench")->add(0.0, wrench);
  expect_one_mode(model);
}

// A load that grows linearly, as between two samples: u(t) = u_static (t - sin wt / w) / T.
TEST(ReducedModel, OneModeUnderARampIsTheClosedForm) {
  const TetMesh mesh = bar_mesh(3);
  Model model(box_settings({kInertia, elastic("3.0e4"), kFixed, "traction: {region: tip, topic: /wrench}"}), mesh);
  Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
  model.loads().courses().at("/wrench")->add(0.0, wrench);
  wrench[0] = 0.02;
  model.loads().courses().at("/wrench")->add(1.0, wrench);
  const ReducedModel reduced(model, {1});
  ASSERT_EQ(reduced.basis().cols(), 1);
  const Eigen::VectorXd b = reduced.basis().col(0);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(b.size());
  model.add_loads(model.point(prior(model)), 1.0, load);
  const double square = b.dot(model.stiffness(prior(model)) * b), w = std::sqrt(square);
  const auto run = reduced.start(prior(model), 0.0);
  for (const double t : {0.01, 0.13, 0.4, 0.99}) {
    run->advance(t);
    const double q = b.dot(load) / square * (t - std::sin(w * t) / w);
    EXPECT_LT((run->displacement() - q * b).norm(), 1e-9 * std::abs(b.dot(load)) / square * b.norm()) << t;
  }
}

// Many instants at once, and one after the other.
TEST(ReducedModel, ShowsManyInstantsAsItShowsEach) {
  const TetMesh mesh = bar_mesh(4);
  const Model model(box_settings({kInertia, elastic("{prior: 3.0e4, factor: 2}"), kFixed, kGravity,
                                  "strain_stiffening: {exponent: {mean: 0.5, std: 0.1}}"}),
                    mesh);
  std::vector<double> times;
  for (int k = 1; k <= 37; ++k) times.push_back(0.013 * k);
  const Eigen::VectorXd theta = prior(model);
  BasisOptions linear;
  linear.nonlinear = BasisOptions::Nonlinear::left_out;
  ReducedModel reduced(model, linear);
  FirstOrderModel first_order(model);
  for (ForwardModel* forward : std::initializer_list<ForwardModel*>{&reduced, &first_order}) {
    for (const OutputNodes& nodes : {OutputNodes(), OutputNodes({3, 7, mesh.node_count() - 1})}) {
      forward->restrict_output_to(nodes);
      const auto run = forward->start(theta, 0.0), step = forward->start(theta, 0.0);
      std::size_t shown = 0;
      forward->advance_through(*run, times, [&](std::size_t k, const Eigen::Ref<const Eigen::VectorXd>& u) {
        ASSERT_EQ(k, shown++);
        step->advance(times[k]);
        const Eigen::VectorXd expected = step->displacement();
        EXPECT_LT((u - expected).norm(), 1e-12 * expected.norm()) << forward->description() << ", instant " << k;
      });
      EXPECT_EQ(shown, times.size());
    }
  }
}

// What tunes a body, and what only acts on it or is only seen.
TEST(Model, KnowsWhatChangesTheAnswerToALoad) {
  const Model model(
      box_settings({kInertia, elastic("{prior: 3.0e4, factor: 2}"), kFixed,
                    "gravity: {acceleration: {mean: [0, 0, -2], std: 1}}", "viscous_damping: {beta: {mean: 0.1, std: 0.1}}",
                    "time_offset: {offset: {mean: 0, std: 0.01}}", "image_scale: {ratio: {mean: 1, std: 0.1}}",
                    "viscoelasticity: {gamma: {mean: 0.2, std: 0.1}, tau: 0.3}"}),
      bar_mesh(2));
  const Eigen::VectorXd w = model.parameters().prior_mean(), std = model.parameters().prior_std();
  const std::set<std::string> tuning{"elasticity.young_modulus", "viscous_damping.beta", "time_offset.offset",
                                     "viscoelasticity.gamma"};
  std::size_t found = 0;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const std::string& name = model.parameters().free()[static_cast<std::size_t>(i)].name;
    const Eigen::VectorXd moved = w + std[i] * Eigen::VectorXd::Unit(w.size(), i);
    EXPECT_EQ(model.same_answer(model.parameters().theta(w), model.parameters().theta(moved)), tuning.count(name) == 0)
        << name;
    found += tuning.count(name);
  }
  EXPECT_EQ(found, tuning.size());
}

TEST(ReducedModel, DoesNotDependOnTheFrames) {
  const TetMesh mesh = bar_mesh(3);
  const Model model(box_settings({kInertia, elastic("3.0e4"), kFixed, kGravity}), mesh);
  const ReducedModel reduced(model);
  const auto one = reduced.start(prior(model), 0.0), many = reduced.start(prior(model), 0.0);
  one->advance(0.5);
  for (const double t : {0.01, 0.013, 0.2, 0.1, 0.2, 0.47, 0.5}) many->advance(t);  // an earlier time changes nothing
  EXPECT_LT((one->displacement() - many->displacement()).norm(), 1e-10 * one->displacement().norm());
}

TEST(ReducedModel, LetsAFreeBodyFallAndFly) {
  const TetMesh mesh = bar_mesh(2);
  const Model model(box_settings({kInertia, elastic("3.0e4"), "gravity: {acceleration: [0, 0, -9.81]}"},
                                 "[{vertices: {topic: /v, noise: 1.0e-4}}]", "initial: {velocity: [1, 0, 2]}"),
                    mesh);
  const ReducedModel reduced(model);
  const auto run = reduced.start(prior(model), 0.0);
  run->advance(0.3);
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Eigen::Vector3d u = run->displacement().segment<3>(3 * i);
    EXPECT_LT((u - Eigen::Vector3d(0.3, 0.0, 0.6 - 0.5 * 9.81 * 0.09)).norm(), 1e-8);
  }
}

TEST(ReducedModel, RefusesWhatItCannotDo) {
  const TetMesh mesh = bar_mesh(1);
  const Model finite(box_settings({kInertia, "elasticity: {law: neo_hookean, young_modulus: 3.0e4, poisson_ratio: 0.4}",
                                   kFixed, kGravity}),
                     mesh);
  EXPECT_NE(refusal([&] { const ReducedModel reduced(finite); }).find("nonlinear"), std::string::npos);
  const Model still(box_settings({kInertia, elastic("3.0e4"), kFixed}), mesh);
  EXPECT_NE(refusal([&] { const ReducedModel reduced(still); }).find("nothing that moves"), std::string::npos);
}

// Whether they are solved for anew or scaled from those of another theta.
TEST(ReducedModel, ModesAreOrthonormalInMassAndDiagonalInStiffness) {
  const TetMesh mesh = bar_mesh(4);
  const Model model(box_settings({kInertia, elastic("{prior: 3.0e4, factor: 2}"), kFixed, kGravity,
                                  "density_error: {relative: {mean: 0, std: 0.2}}",
                                  "period_elongation: {step_squared: {prior: 1.0e-5, factor: 3}}",
                                  "foundation: {region: top, stiffness: {prior: 1.0e5, factor: 3}}"}),
                    mesh);
  const ReducedModel reduced(model);
  const Eigen::MatrixXd& b = reduced.basis();
  Eigen::VectorXd all = model.parameters().prior_mean(), last = all;
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    Eigen::VectorXd one = model.parameters().prior_mean();
    one[i] += model.parameters().prior_std()[i];  // scaled, but for the foundation's and the modulus'
    all += 0.5 * model.parameters().prior_std()[i] * Eigen::VectorXd::Unit(all.size(), i);
    for (const Eigen::VectorXd& w : {one, all, last}) {
      const Eigen::VectorXd theta = model.parameters().theta(w);
      const auto modes = reduced.modes(theta);
      const Eigen::MatrixXd body = model.mass(theta) * b, stiffness = b.transpose() * (model.stiffness(theta) * b),
                            inertia = model.stiffness_inertia(theta) * (model.reference_stiffness(theta) * b),
                            mass = b.transpose() * (body + inertia);
      const Eigen::MatrixXd& shapes = modes->shapes;
      const Eigen::MatrixXd one_mass = shapes.transpose() * mass * shapes,
                            squares = shapes.transpose() * stiffness * shapes;
      EXPECT_LT((one_mass - Eigen::MatrixXd::Identity(b.cols(), b.cols())).norm(), 1e-8);
      EXPECT_LT((squares - Eigen::MatrixXd(modes->square.asDiagonal())).norm(), 1e-8 * modes->square.norm());
      EXPECT_LT((modes->to_modal - shapes.transpose() * mass).norm(), 1e-8 * modes->to_modal.norm());
      const Eigen::MatrixX3d unit = Eigen::Matrix3d::Identity().replicate(b.rows() / 3, 1);
      EXPECT_LT((modes->weight - shapes.transpose() * (body.transpose() * unit)).norm(), 1e-8 * modes->weight.norm());
    }
  }
}

// What the mesh does to a body's frequencies is found without a factor.
TEST(ReducedModel, NeedsNoFactorBesideTheMeshThatItsOwnWasRefinedFrom) {
  const TetMesh coarse = bar_mesh(8, 2, 2), fine = refine_mesh(coarse);
  BasisOptions between;
  between.coarser = std::make_shared<const Prolongation>(prolongation(coarse, fine));
  const std::vector<std::string> known = {kInertia, elastic("{prior: 3.0e4, factor: 2}"), kFixed, kGravity};
  std::vector<std::string> more = known;
  more.push_back("foundation: {region: top, stiffness: {mean: 0, std: 1.0e4}}");
  for (const std::vector<std::string>& effects : {known, more}) {
    const Model parent(box_settings(effects), coarse), model(box_settings(effects), fine);
    ASSERT_GT(model.fem().dof_count(), 6000);
    const auto lowest = [](const Model& of, const BasisOptions& options) {
      const Eigen::VectorXd theta = of.parameters().theta(of.parameters().prior_mean() + 0.3 * of.parameters().prior_std());
      return Eigen::ArrayXd(ReducedModel(of, options).modes(theta)->square.head(6));
    };
    const Eigen::ArrayXd wanted = lowest(model, {}), found = lowest(model, between);
    const double mesh = (lowest(parent, {}) / wanted - 1.0).abs().mean(), off = (found / wanted - 1.0).abs().mean();
    std::printf("frequencies' squares, %s: of the mesh %.1e, without a factor %.1e\n", effects.back().c_str(), mesh, off);
    EXPECT_GT(mesh, 1e-3) << effects.back();
    EXPECT_LT(off, 0.02 * mesh) << effects.back();
  }
}

}  // namespace
}  // namespace tissue_stiffness
