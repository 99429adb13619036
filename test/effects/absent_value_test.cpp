// At its absent value every effect leaves the model as it is without the effect.
#include <gtest/gtest.h>

#include <cmath>

#include "every_effect.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

// At least one parameter has a value that takes the effect away.
bool can_be_absent(const EffectSpec& spec) {
  bool found = false;
  for (const ParameterSpec& p : spec.parameters) {
    EXPECT_TRUE(std::isnan(p.absent) || (p.absent >= p.lower && p.absent <= p.upper)) << spec.name << "." << p.name;
    found = found || std::isfinite(p.absent);
  }
  return found;
}

Arguments absent_arguments(const EffectSpec& spec, const std::string& law) {
  Arguments arguments = example_arguments(spec, law);
  for (const ParameterSpec& p : spec.parameters) {
    if (std::isfinite(p.absent)) arguments[p.name] = text(p, p.absent);
  }
  return arguments;
}

// What a sensor sees of the swinging bar.
Eigen::VectorXd swing(const std::vector<std::string>& effects, const TetMesh& mesh, bool reduced = false) {
  Model model(box_settings(effects), mesh);
  feed(model);
  const Eigen::VectorXd theta = model.parameters().theta(model.parameters().prior_mean());
  FullModel::Options options;
  options.step = 0.002;
  std::unique_ptr<ForwardModel> forward = std::make_unique<FullModel>(model, options);
  if (reduced) forward = std::make_unique<ReducedModel>(model);
  const auto run = forward->start(theta, 0.0);
  run->advance(0.02 - model.sensors().delay(theta));
  const ObservedMotion seen = model.sensors().observe(theta, 0.02, run->displacement());
  Eigen::VectorXd all(seen.displacement.size() + 1);
  all << seen.displacement, seen.outward;
  return all;
}

TEST(EveryEffect, AtItsAbsentValueTheModelWithoutItComesBackBitForBit) {
  const TetMesh mesh = bar_mesh(3);
  for (const std::string law : {"linear", "neo_hookean"}) {
    const Eigen::VectorXd without = swing(bar_with("", {}, law), mesh);
    EXPECT_GT(without.norm(), 1e-4);
    int compared = 0;
    for (const EffectSpec& spec : effect_specs()) {
      if (!can_be_absent(spec) || !fits(spec, law)) continue;
      EXPECT_EQ(swing(bar_with(spec.name, absent_arguments(spec, law), law), mesh), without) << spec.name << ", " << law;
      EXPECT_NE(swing(bar_with(spec.name, example_arguments(spec, law), law), mesh), without)
          << spec.name << " does nothing at all";
      ++compared;
    }
    EXPECT_GE(compared, 9);
  }
}

TEST(EveryEffect, AtItsAbsentValueTheReducedModelIsTheSameToo) {
  const TetMesh mesh = bar_mesh(3);
  const Eigen::VectorXd without = swing(bar_with("", {}), mesh, true);
  int compared = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!can_be_absent(spec) || !fits(spec, "linear")) continue;
    const Model model(box_settings(bar_with(spec.name, absent_arguments(spec, "linear"))), mesh);
    if (model.nonlinear()) continue;
    EXPECT_EQ(swing(bar_with(spec.name, absent_arguments(spec, "linear")), mesh, true), without) << spec.name;
    ++compared;
  }
  EXPECT_GE(compared, 9);
}

}  // namespace
}  // namespace tissue_stiffness
