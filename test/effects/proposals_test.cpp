// What effects propose of themselves: every proposal is a model file's entry that changes nothing at its absent value.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "../box_model.hpp"
#include "effects/fibre_field.hpp"
#include "effects/registry.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

const std::vector<std::string> kBase{
    "inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: {prior: 3.0e4, factor: 3}, poisson_ratio: 0.4}",
    "fixed: {region: clamp}", "traction: {region: tip, topic: /load}"};
const std::string kObservations =
    "[{vertices: {topic: /vertices, noise: 1.0e-4}}, {points: {topic: /points, noise: 1.0e-4}}]";

std::vector<Proposal> proposals_of(const EffectSpec& spec, const Model& model) {
  const ProposalContext context{model.settings(), model.mesh(), model.body().regions, 3e4, 0.4, 1000.0, 0.02, 2.0};
  return spec.proposals ? spec.proposals(context) : std::vector<Proposal>{};
}

struct Swing {
  Eigen::VectorXd displacement;
  double delay, outward;
};

Swing swing(const std::vector<std::string>& effects, const TetMesh& mesh) {
  Model model(box_settings(effects, kObservations), mesh);
  for (auto& course : model.loads().courses()) {
    if (!course.second->from_file()) course.second->add(0.0, Eigen::VectorXd::LinSpaced(6, 0.01, 0.02));
  }
  const Eigen::VectorXd theta = model.parameters().theta(model.parameters().prior_mean());
  FullModel::Options options;
  options.step = 0.005;
  const auto run = FullModel(model, options).start(theta, 0.0);
  run->advance(0.02);
  const ObservedMotion seen = model.sensors().observe(theta, 0.02, run->displacement());
  return {seen.displacement, model.sensors().delay(theta), seen.outward};
}

std::vector<std::string> with(const std::string& effect) {
  std::vector<std::string> effects = kBase;
  effects.push_back(effect);
  return effects;
}

std::vector<std::string> with(const EffectEntry& effect) {
  return with(to_yaml(effect));
}

TEST(Proposals, ChangeNothingAtTheirAbsentValue) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  const Swing without = swing(kBase, mesh);
  for (const EffectSpec& spec : effect_specs()) {
    for (const Proposal& proposal : proposals_of(spec, base)) {
      const Swing absent = swing(with(proposal.entry), mesh);
      EXPECT_EQ(absent.displacement, without.displacement) << to_yaml(proposal.entry);
      EXPECT_EQ(absent.delay, 0.0) << to_yaml(proposal.entry);
      EXPECT_EQ(absent.outward, 0.0) << to_yaml(proposal.entry);
    }
  }
}

TEST(Proposals, EstimateTheirAmplitudeAndNothingElse) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  for (const EffectSpec& spec : effect_specs()) {
    for (const Proposal& proposal : proposals_of(spec, base)) {
      const Model model(box_settings(with(proposal.entry), kObservations), mesh);
      const auto parameter = std::find_if(spec.parameters.begin(), spec.parameters.end(),
                                          [&](const ParameterSpec& p) { return p.name == proposal.amplitude; });
      ASSERT_NE(parameter, spec.parameters.end()) << to_yaml(proposal.entry);
      ASSERT_EQ(model.parameters().free().size(), 1U + static_cast<std::size_t>(parameter->components))
          << to_yaml(proposal.entry);
      for (std::size_t i = 1; i < model.parameters().free().size(); ++i) {
        const FreeParameter& free = model.parameters().free()[i];
        EXPECT_EQ(free.name.find(spec.name + "." + proposal.amplitude), 0U) << free.name;
        EXPECT_EQ(free.prior.value, parameter->absent) << to_yaml(proposal.entry);
        EXPECT_GT(free.prior.spread, 0.0);
      }
    }
  }
}

TEST(Proposals, StartARefitThatMovesTheModel) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  const Swing without = swing(kBase, mesh);
  for (const EffectSpec& spec : effect_specs()) {
    std::map<std::string, int> seen;
    for (const Proposal& proposal : proposals_of(spec, base)) {
      EXPECT_EQ(++seen[to_yaml(proposal.entry)], 1) << to_yaml(proposal.entry) << " twice";
      const Model model(box_settings(with(proposal.refine), kObservations), mesh);
      EXPECT_TRUE(model.parameters().free().size() >= 2U || model.nonlinear()) << to_yaml(proposal.refine);
      EXPECT_EQ(proposal.entry.effect, spec.name);
      EXPECT_EQ(proposal.refine.effect, spec.name);
    }
  }
}

// Fits that only rank would project a stiffness anew at each sigma point of a place or a direction.
TEST(Proposals, AreRankedWithoutAnEstimatedShape) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  std::set<std::string> shaped;
  for (const EffectSpec& spec : effect_specs()) {
    for (const Proposal& proposal : proposals_of(spec, base)) {
      const EffectEntry entry = proposal.with_given_shape();
      const Model model(box_settings(with(entry), kObservations), mesh);
      EXPECT_TRUE(model.parameters().free().size() >= 2U || model.nonlinear()) << to_yaml(entry);
      if (!entry.same(proposal.refine)) shaped.insert(spec.name);
      const Eigen::VectorXd w = model.parameters().prior_mean(), std = model.parameters().prior_std();
      const Eigen::VectorXd theta = model.parameters().theta(w), moved = model.parameters().theta(w + std);
      for (const Model::Part& part : model.parts()) {
        for (const StrainTerm& term : part.terms.strain_stiffness) {
          for (const int k : term.shape) EXPECT_EQ(part.parameters(moved)[k], part.parameters(theta)[k]) << to_yaml(entry);
        }
      }
    }
  }
  EXPECT_EQ(shaped, (std::set<std::string>{"fibre_reinforcement", "stiff_inclusion"}));
}

TEST(Proposals, AreNotMadeForWhatIsThere) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  int effects = 0;
  for (const EffectSpec& spec : effect_specs()) {
    const std::vector<Proposal> list = proposals_of(spec, base);
    if (list.empty()) continue;
    ++effects;
    const Model model(box_settings(with(list.front().entry), kObservations), mesh);
    for (const Proposal& again : proposals_of(spec, model)) EXPECT_FALSE(again.entry.same(list.front().entry));
  }
  EXPECT_GE(effects, 5);
}

// A model file that holds the text of a proposal has the very effect that the proposal stands for.
TEST(Proposals, ReadBackFromTheirText) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  for (const EffectSpec& spec : effect_specs()) {
    for (const Proposal& proposal : proposals_of(spec, base)) {
      for (const EffectEntry& entry : {proposal.entry, proposal.refine}) {
        const std::string text = to_yaml(entry);
        EXPECT_TRUE(parse_yaml(text, "").at(spec.name).same(to_settings(entry).arguments)) << text;
      }
    }
  }
}

std::vector<Proposal> proposals_of(const std::string& effect, const Model& model) {
  for (const EffectSpec& spec : effect_specs()) {
    if (spec.name == effect) return proposals_of(spec, model);
  }
  return {};
}

// How many of an effect's proposals are the first one but for its kind.
std::ptrdiff_t other_kinds(const std::vector<Proposal>& list) {
  return std::count_if(list.begin(), list.end(), [&](const Proposal& p) { return p.is_other_kind_of(list.front()); });
}

TEST(Proposals, KnowTheirOtherKinds) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  const auto foundations = proposals_of("foundation", base);
  ASSERT_EQ(to_yaml(foundations[0].refine.without("stiffness")), "foundation: {}");  // on the whole surface
  EXPECT_EQ(foundations[0].kind(), "");
  EXPECT_EQ(foundations[1].kind(), "[1, 0, 0]");  // the clamp holds the end that faces -x
  EXPECT_EQ(foundations.back().kind(), "top");
  EXPECT_EQ(foundations.size(), 11U);  // everywhere, five sides, five regions
  EXPECT_TRUE(foundations[1].is_other_kind_of(foundations.back()));
  EXPECT_TRUE(foundations[0].is_other_kind_of(foundations[1]));
  EXPECT_FALSE(foundations[0].is_other_kind_of(foundations[0]));
  EXPECT_EQ(other_kinds(foundations), static_cast<std::ptrdiff_t>(foundations.size()) - 1);
  EXPECT_EQ(other_kinds(proposals_of("added_mass", base)), 4);  // five regions; a fit moves the places
  // Along x, the bar's length: circumferential, longitudinal and radial without an angle, circumferential with two, y, z
  // and ten oblique directions.
  const auto fibres = proposals_of("fibre_reinforcement", base);
  EXPECT_EQ(fibres.front().kind(), "circumferential");
  EXPECT_EQ(fibres.back().kind(), "");
  EXPECT_EQ(fibres.size(), 17U);
  EXPECT_EQ(other_kinds(fibres), 2);
  // The same rhythm in the other directions.
  EXPECT_EQ(other_kinds(proposals_of("active_contraction", base)), 3);
  for (const std::string effect : {"viscoelasticity", "stiff_inclusion", "rigid_drift"}) {
    EXPECT_EQ(other_kinds(proposals_of(effect, base)), 0) << effect;
  }
}

TEST(Proposals, CoverTheHalfSphereWithStraightFibres) {
  const TetMesh mesh = bar_mesh(2);
  std::vector<Eigen::Vector3d> directions{Eigen::Vector3d::UnitX()};  // longitudinal
  for (const FibreField::Trial& trial : FibreField::trials(mesh)) {
    if (trial.straight) directions.push_back(std::get<Eigen::Vector3d>(trial.direction.content));
  }
  for (const FibreField::Trial& trial : FibreField::oblique_trials()) {
    ASSERT_TRUE(trial.straight);
    directions.push_back(std::get<Eigen::Vector3d>(trial.direction.content).normalized());
  }
  EXPECT_EQ(directions.size(), 13U);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Vector3d any = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    double nearest = 0.0;
    for (const Eigen::Vector3d& d : directions) nearest = std::max(nearest, std::abs(d.dot(any)));
    EXPECT_GT(nearest, std::cos(27.6 * M_PI / 180.0)) << any.transpose();
  }
}

TEST(Proposals, TestADeclaredGravityButNoEstimatedOne) {
  const TetMesh mesh = bar_mesh(2);
  for (const EffectSpec& spec : effect_specs()) {
    if (spec.name != "gravity") continue;
    const Model declared(box_settings(with("gravity: {acceleration: [0, 0, -9.81]}"), kObservations), mesh);
    EXPECT_EQ(proposals_of(spec, declared).size(), 1U);
    const Model estimated(box_settings(with("gravity: {acceleration: {mean: [0, 0, -9.81], std: 1}}"), kObservations),
                          mesh);
    EXPECT_TRUE(proposals_of(spec, estimated).empty());
  }
}

// A clamp may be drawn too large or too small.
TEST(Proposals, DoubtTheExtentOfAClamp) {
  const TetMesh mesh = bar_mesh(4, 2, 2);
  ModelSettings settings = box_settings(kBase, kObservations);
  settings.regions.front().shape = BoxShape{{-1.0, -1.0, -1.0}, {0.03, 0.011, 1.0}};
  const auto kinds = [](const std::vector<Proposal>& list) {
    std::vector<std::string> out;
    for (const Proposal& proposal : list) out.push_back(proposal.kind());
    return out;
  };
  const Model deep(settings, mesh);
  const std::vector<std::string> supports = kinds(proposals_of("elastic_support", deep));
  ASSERT_GE(supports.size(), 3U);
  EXPECT_EQ(supports.front(), "clamp");
  EXPECT_EQ(supports.back().rfind("clamp ", 0), 0U) << supports.back();
  const auto beside = [&](const Model& model) {
    const std::vector<Proposal> list = proposals_of("foundation", model);
    const auto level = [](const Proposal& p) { return to_yaml(p.entry).find("level_with") != std::string::npos; };
    return std::count_if(list.begin(), list.end(), level);
  };
  EXPECT_EQ(beside(deep), 0) << "a clamp with corners is not flat";
  settings.regions.front().shape = BoxShape{{-1.0, -1.0, -1.0}, {1e-6, 0.011, 1.0}};
  EXPECT_EQ(beside(Model(settings, mesh)), 1);
  EXPECT_EQ(beside(Model(box_settings(kBase, kObservations), mesh)), 0) << "the whole end is held";
}

TEST(Proposals, AreMadeByEveryEffectThatFitsTheModel) {
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  std::vector<std::string> effects;
  for (const EffectSpec& spec : effect_specs()) {
    if (!proposals_of(spec, base).empty()) effects.push_back(spec.name);
  }
  std::sort(effects.begin(), effects.end());
  const std::vector<std::string> expected{"active_contraction",
                                          "added_mass",
                                          "compressibility",
                                          "contour_bias",
                                          "density_error",
                                          "elastic_support",
                                          "fibre_reinforcement",
                                          "force_scale",
                                          "foundation",
                                          "geometric_nonlinearity",
                                          "gravity",
                                          "image_scale",
                                          "load_offset",
                                          "load_rotation",
                                          "mass_damping",
                                          "period_elongation",
                                          "rigid_drift",
                                          "sensor_rotation",
                                          "stiff_inclusion",
                                          "strain_stiffening",
                                          "time_offset",
                                          "viscoelasticity",
                                          "viscous_damping"};
  EXPECT_EQ(effects, expected);
}

// The tangents are judged by their prior: a sensor drifts by a hundredth of the body, and comes late by one frame.
TEST(Proposals, OfSensorsAreAsLargeAsErrorsOfSensorsAre) {
  constexpr double kDuration = 2.0, kInterval = 0.02;  // of proposals_of
  const TetMesh mesh = bar_mesh(2);
  const Model base(box_settings(kBase, kObservations), mesh);
  const auto spread = [&](const std::string& effect, std::size_t number) {
    const Model model(box_settings(with(proposals_of(effect, base).at(number).entry), kObservations), mesh);
    return model.parameters().free().at(1).prior.spread;
  };
  const double size = std::sqrt(0.1 * 0.1 + 2 * 0.02 * 0.02);
  EXPECT_NEAR(spread("rigid_drift", 0) * kDuration, 0.01 * size, 1e-6 * size);
  EXPECT_NEAR(spread("rigid_drift", 1) * kDuration, 0.01, 1e-6);
  EXPECT_NEAR(spread("time_offset", 0), kInterval, 1e-6);
  EXPECT_NEAR(spread("image_scale", 0), 0.05, 1e-6);
}

TEST(Proposals, NeedWhatTheyActOn) {
  const TetMesh mesh = bar_mesh(2);
  const Model loose(box_settings({kBase[0], kBase[1], "gravity: {acceleration: [0, 0, -9.81]}"}), mesh);
  for (const EffectSpec& spec : effect_specs()) {
    if (spec.name != "elastic_support" && spec.name.rfind("load_", 0) != 0) continue;
    EXPECT_TRUE(proposals_of(spec, loose).empty()) << spec.name;
  }
}

}  // namespace
}  // namespace tissue_stiffness
