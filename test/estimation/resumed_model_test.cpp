// A body that goes on moving while its clock is set: nothing is known of its rest, and much of its modulus.
#include "estimation/resumed_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;
constexpr int kLast = 400;         // load samples
constexpr double kLoaded = 0.005;  // [s] between them

std::vector<std::string> pushed_bar() {
  return {"inertia: {density: 1000}", modulus(prior(50e3, 3)), "fixed: {region: clamp}", "viscous_damping: {beta: 3.0e-3}",
          "traction: {region: tip, topic: /wrench}"};
}

LoadSample load(int k) {
  return swaying_wrench(kLoaded * k, 9.0, 7.0);
}

/// The frames from `first` on, which an estimator of `model` sees as its first ones.
StepResult estimated(const ModelSettings& model, std::size_t first) {
  Experiment bar(box_settings(pushed_bar()), bar_mesh(), {kTruth});
  for (int k = 0; k < kLast; ++k) bar.add_load(load(k));
  std::vector<Experiment::Moment> moments = bar.film(0.0, kFilmed, 80);
  moments.erase(moments.begin(), moments.begin() + static_cast<std::ptrdiff_t>(first));
  Estimator estimator(model, bar_mesh());
  estimator.set_first_stamp(moments.front().time);
  for (int k = 0; k < kLast; ++k) {
    if (kLoaded * k >= moments.front().time - 0.01) estimator.add_load(load(k));
  }
  return step_through(estimator, see_all(bar, moments, kNoise, 3));
}

Estimate known(double mean, double std) {
  Estimate out;
  out.state = EstimateState::converged;
  out.parameters = {{"elasticity.young_modulus", "Pa", mean, std, mean - 2 * std, mean + 2 * std}};
  return out;
}

TEST(ResumedModel, FindsTheMotionBesideTheModulus) {
  const StepResult last = estimated(in_motion(box_settings(pushed_bar()), bar_mesh()), 30);
  const ParameterEstimate& p = last.estimate.parameters.front();
  std::printf("resumed from the prior: E %+.2f %% off, std %.2f %%, %s\n", 100.0 * (p.mean / kTruth - 1.0),
              100.0 * p.std / p.mean, to_string(last.estimate.state).c_str());
  EXPECT_LT(std::abs(p.mean - kTruth), 3.0 * p.std);
  EXPECT_NEAR(p.mean / kTruth, 1.0, 0.01);
  EXPECT_EQ(last.estimate.state, EstimateState::converged);
}

// Few frames tell little of both, so that what was known before is needed, and is enough to call the modulus known.
TEST(ResumedModel, GoesOnWithTheModulusThatWasKnown) {
  const std::size_t late = 66;
  ModelSettings model = in_motion(box_settings(pushed_bar()), bar_mesh());
  const ParameterEstimate blind = estimated(model, late).estimate.parameters.front();
  take_moduli(model, known(kTruth, 0.01 * kTruth));
  const StepResult last = estimated(model, late);
  const ParameterEstimate& p = last.estimate.parameters.front();
  EXPECT_LT(p.std, 0.0101 * kTruth);
  EXPECT_LT(p.std, blind.std);
  EXPECT_TRUE(holds(p, kTruth));
  EXPECT_EQ(last.estimate.state, EstimateState::converged) << last.estimate.state_reason;
}

TEST(ResumedModel, TakesMeanAndSpreadOfWhatWasKnown) {
  ModelSettings model =
      box_settings({"elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: 1e4, factor: 3, "
                    "drift: 0.1}, region: near}",
                    "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: 2.0e4, region: far}"});
  Estimate before = known(3e4, 6e3);
  before.parameters.push_back({"elasticity#2.young_modulus", "Pa", 1e3, 1e2, 8e2, 1.2e3});
  before.parameters.push_back({"viscous_damping.beta", "s", 1e-3, 1e-4, 8e-4, 1.2e-3});
  take_moduli(model, before);
  const Quantity q = model.effects[0].arguments.at("young_modulus").as_quantity(0.0, 1e12, "Pa");
  const double log_std = std::log(q.spread);
  EXPECT_NEAR(q.value * std::exp(0.5 * log_std * log_std), 3e4, 1.0);      // its mean
  EXPECT_NEAR(std::sqrt(std::expm1(log_std * log_std)), 6e3 / 3e4, 1e-9);  // its relative deviation
  EXPECT_EQ(q.drift, 0.1);
  EXPECT_EQ(model.effects[1].arguments.at("young_modulus").as_number(0, 1e9, "Pa"), 2e4) << "a known number stays";
  EXPECT_EQ(model.known_before, std::vector<std::string>{"elasticity.young_modulus"});
}

TEST(ResumedModel, RefusesWhatIsOnlyKnownSinceTheRest) {
  const auto refused = [](const std::string& effect) {
    return refusal([&] { in_motion(box_settings({effect}), bar_mesh()); });
  };
  EXPECT_NE(refused("traction: {region: tip, course: {file: push.csv}}").find("a load from a file"), std::string::npos);
  EXPECT_NE(refused("moved: {region: tip, topic: /pose}").find("the pose of a moved region"), std::string::npos);
  EXPECT_EQ(refused("traction: {region: tip, topic: /wrench}"), "");
}

TEST(ResumedModel, KeepsAMotionThatTheModelStates) {
  const ModelSettings model = in_motion(box_settings({"initial_motion: {velocity: {mean: [0, 0, 0], std: 0.2}}"},
                                                     "[{vertices: {topic: /v, noise: 1e-4}}]", "time: {start: 0.3}\n"),
                                        bar_mesh());
  EXPECT_EQ(model.effects.size(), 1U);
  EXPECT_EQ(model.time.start, 0.0);
}

}  // namespace
}  // namespace tissue_stiffness
