// Errors of loads, poses and constants are found where the data tell them, and are in the interval where they do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "bar.hpp"
#include "meshing/offset_surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3;
using Change = std::function<void(LoadSample&)>;

ModelSettings pushed(const std::string& load_keys = "", const std::string& density = "1000") {
  ModelSettings model =
      box_settings({"inertia: {density: " + density + "}", modulus(prior(30e3, 3)), "fixed: {region: clamp}",
                    "viscous_damping: {beta: 4.0e-3}", "traction: {region: tip, topic: /wrench" + load_keys + "}"});
  model.exact_inputs = false;
  return model;
}

// Returns the estimate after 60 frames of a bar whose wrench is recorded with `error`.
StepResult estimated(const ModelSettings& model, const Change& error) {
  const TetMesh mesh = bar_mesh();
  ModelSettings truth = model;
  Experiment bar(truth, mesh, {kTruth});
  Estimator estimator(model, mesh);
  estimator.set_first_stamp(0.0);
  for (int k = 0; k < 260; ++k) {
    LoadSample sample = swaying_wrench(0.005 * k);
    bar.add_load(sample);
    error(sample);
    estimator.add_load(sample);
  }
  return step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 60), kNoise, 7));
}

const InputUncertainty& find(const Estimate& estimate, const std::string& error) {
  for (const InputUncertainty& input : estimate.inputs) {
    if (input.error == error) return input;
  }
  throw std::logic_error("no " + error);
}

TEST(InputStudy, HoldsTheTruthWhateverTheWrenchDoesWithinItsTolerance) {
  const std::vector<std::pair<std::string, Change>> errors{
      {"none", [](LoadSample&) {}},
      {"gain", [](LoadSample& s) { s.value *= 1.1; }},
      {"bias", [](LoadSample& s) { s.value[2] += 1.5e-3; }},
      {"direction", [](LoadSample& s) { s.value[1] -= 0.05 * s.value[2]; }}};
  for (const auto& [name, error] : errors) {
    const StepResult last = estimated(pushed(), error);
    const ParameterEstimate& p = last.estimate.parameters.front();
    std::printf("%s: %.0f Pa (%.0f to %.0f), %s: %s\n", name.c_str(), p.mean, p.lower95, p.upper95,
                to_string(last.estimate.state).c_str(), last.estimate.state_reason.c_str());
    EXPECT_TRUE(holds(p, kTruth)) << name;
    EXPECT_EQ(last.estimate.state, EstimateState::converged) << name << ": " << last.estimate.state_reason;
  }
}

// A stiff undamped bar, which a load moves slowly. `gain` is the tolerance of the load's gain.
constexpr double kStiff = 200e3;
ModelSettings slow_bar(const std::string& density, const std::string& gain) {
  ModelSettings model =
      box_settings({"inertia: {density: " + density + "}", modulus(prior(300e3, 3)), "fixed: {region: clamp}",
                    "traction: {region: tip, topic: /wrench, gain: " + gain +
                        ", bias: 0, hysteresis: 0, delay: 0, direction: 0, noise: 0}"});
  model.exact_inputs = false;
  return model;
}

// Gives the slow load to the bar, and to its estimator with a gain.
void push_slowly(Experiment& bar, Estimator& estimator, double gain) {
  estimator.set_first_stamp(0.0);
  for (int k = 0; k < 260; ++k) {
    LoadSample sample{"/wrench", 0.005 * k, Eigen::VectorXd::Zero(6)};
    sample.value[2] = -0.1 * (1.0 - std::cos(5.0 * sample.time));
    bar.add_load(sample);
    sample.value *= gain;
    estimator.add_load(sample);
  }
}

// A load moves a stiff undamped bar slowly, so E is proportional to the gain. Small fast swings, whose phases depend on E
// alone, tell them apart. The density's tolerance then is most of what is left.
TEST(InputStudy, FindsTheModulusBesideAWrongGain) {
  constexpr double kGain = 1.15;
  const ModelSettings model = slow_bar("1000", "0.1");
  const TetMesh mesh = bar_mesh();
  Experiment bar(model, mesh, {kStiff});
  Estimator estimator(model, mesh);
  push_slowly(bar, estimator, kGain);
  const StepResult last = step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 60), kNoise, 7));
  const ParameterEstimate& p = last.estimate.parameters.front();
  std::printf("slow bar, gain %.2f: E/truth %.3f (%.3f to %.3f)\n", kGain, p.mean / kStiff, p.lower95 / kStiff,
              p.upper95 / kStiff);
  EXPECT_TRUE(holds(p, kStiff));
  EXPECT_NEAR(p.mean / kStiff, 1.0, 0.03);  // the gain alone would make it 1.15
  EXPECT_GT(p.std / p.mean, 0.05);
}

TEST(InputStudy, FindsABiasWithItsSign) {
  const double exact = find(estimated(pushed(), [](LoadSample&) {}).estimate, "bias").mean;
  const StepResult last = estimated(pushed(), [](LoadSample& s) { s.value[2] += 1.5e-3; });
  const InputUncertainty& bias = find(last.estimate, "bias");
  EXPECT_GT(bias.mean, 4.0 * exact);
  EXPECT_NEAR(bias.mean * std::sqrt(3.0), 1.5e-3, 5e-4);
  EXPECT_LT(bias.std, 0.7 * std::sqrt(2.0) * bias.tolerance);  // of Student's standard deviation
}

TEST(InputStudy, CallsABiasFarBeyondItsToleranceDoubtful) {
  const StepResult last = estimated(pushed(", bias: 1.0e-5, noise: 0"), [](LoadSample& s) { s.value[2] += 3e-3; });
  EXPECT_NE(last.estimate.state, EstimateState::converged) << last.estimate.state_reason;
  EXPECT_FALSE(last.estimate.state_reason.empty());
}

TEST(InputStudy, CountsTheToleranceOfAConstant) {
  const auto std_with = [](const std::string& density) {
    const StepResult last = estimated(
        pushed(", gain: 0, bias: 0, noise: 0, delay: 0, hysteresis: 0, direction: 0", density), [](LoadSample&) {});
    return last.estimate.parameters.front().std;
  };
  const double exact = std_with("{value: 1000, tolerance: 0}"), uncertain = std_with("{value: 1000, tolerance: 300}");
  EXPECT_GT(uncertain, 1.1 * exact);
}

// The tolerance of 30 % in the density is all that makes E uncertain here: whoever asks what to measure better is told so.
TEST(InputStudy, NamesTheInputThatMovesTheModulusMost) {
  const StepResult last = estimated(
      pushed(", gain: 0, bias: 0, noise: 0, delay: 0, hysteresis: 0, direction: 0", "{value: 1000, tolerance: 300}"),
      [](LoadSample&) {});
  const std::vector<InputUncertainty>& inputs = last.estimate.inputs;
  ASSERT_FALSE(inputs.empty());
  EXPECT_EQ(inputs.front().input, "inertia.density");
  double constants = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (i > 0) {
      EXPECT_LE(inputs[i].modulus_std, inputs[i - 1].modulus_std);
    }
    if (inputs[i].error == "value") constants += std::pow(inputs[i].modulus_std, 2);
  }
  const ParameterEstimate& e = last.estimate.parameters.front();
  const double variance = std::log1p(std::pow(e.std / e.mean, 2));  // of the logarithm
  EXPECT_NEAR(constants / (variance * last.estimate.variance.front().constants), 1.0, 0.1);
}

// A clamped bar that is bent slowly by a force F at its end sags by F L^3 / (3 E b h^3 / 12). With its surface d further
// out, b and h grow by 2 d each, and so does L.
constexpr double kThickness = 0.02, kLength = 0.1, kSurface = 1e-4;
double bending_stiffness(double outward) {
  return std::pow(kThickness + 2.0 * outward, 4) / std::pow(kLength + 2.0 * outward, 3);
}

// Returns the estimate of a bar whose surface is that far out, with a model whose surface is elsewhere, and the tolerance
// that it states.
Estimate of_slow_bar(double outward, double of_model, double tolerance) {
  ModelSettings model = slow_bar("{value: 1000, tolerance: 0}", "0");
  model.mesh.scale_tolerance = 0.0;
  model.mesh.surface_tolerance = tolerance;
  const TetMesh mesh = offset_surface(bar_mesh(), of_model), true_mesh = offset_surface(bar_mesh(), outward);
  Experiment bar(model, true_mesh, {kStiff});
  Estimator estimator(model, mesh);
  push_slowly(bar, estimator, 1.0);
  std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 60), kNoise, 7);
  for (Frame& frame : frames) {
    Observation& seen = frame.observations.front();
    for (Eigen::Index i = 0; i < seen.points.cols(); ++i)
      seen.points.col(i) += mesh.nodes.col(seen.ids[i]) - true_mesh.nodes.col(seen.ids[i]);  // as on the model's surface
  }
  return step_through(estimator, frames).estimate;
}

TEST(InputStudy, CountsTheToleranceOfTheSurface) {
  const Estimate estimate = of_slow_bar(0.0, 0.0, kSurface);
  const auto of_surface = [](const InputUncertainty& input) { return input.input == "mesh.surface"; };
  const auto found = std::find_if(estimate.inputs.begin(), estimate.inputs.end(), of_surface);
  ASSERT_NE(found, estimate.inputs.end());
  EXPECT_EQ(found->tolerance, kSurface);
  const double expected = std::log(bending_stiffness(kSurface) / bending_stiffness(0.0));
  EXPECT_NEAR(found->modulus_std / (std::sqrt(2.0) * expected), 1.0, 0.15);  // of Student's standard deviation
}

TEST(InputStudy, HoldsTheTruthOfABodyWhoseSurfaceIsOff) {
  const double off = 2.0 * kSurface;
  for (const auto& [outward, of_model] : {std::make_pair(off, 0.0), std::make_pair(0.0, off)}) {
    const ParameterEstimate p = of_slow_bar(outward, of_model, kSurface).parameters.front();
    std::printf("surface %.2f mm, the model's %.2f mm further out: E/truth %.3f (%.3f to %.3f)\n", 1e3 * outward,
                1e3 * of_model, p.mean / kStiff, p.lower95 / kStiff, p.upper95 / kStiff);
    EXPECT_NEAR(std::log(p.mean / kStiff) / std::log(bending_stiffness(outward) / bending_stiffness(of_model)), 1.0, 0.15);
    EXPECT_TRUE(holds(p, kStiff));
    EXPECT_FALSE(holds(of_slow_bar(outward, of_model, 0.0).parameters.front(), kStiff));
  }
}

TEST(InputStudy, SharesOfTheVarianceAddUpToOne) {
  const StepResult last = estimated(pushed(), [](LoadSample&) {});
  ASSERT_EQ(last.estimate.variance.size(), 1U);
  const VarianceShares& s = last.estimate.variance.front();
  EXPECT_NEAR(s.noise + s.mesh + s.loads + s.constants + s.model, 1.0, 1e-9);
  EXPECT_GT(s.loads, 0.05);
}

TEST(InputStudy, WithExactInputsAddsNothing) {
  ModelSettings exact = pushed();
  exact.exact_inputs = true;
  const StepResult last = estimated(exact, [](LoadSample&) {});
  EXPECT_TRUE(last.estimate.inputs.empty());
  EXPECT_EQ(last.estimate.variance.front().loads, 0.0);
  EXPECT_EQ(last.estimate.variance.front().constants, 0.0);
  EXPECT_TRUE(holds(last.estimate.parameters.front(), kTruth));
}

// Two tolerances of 0.01 would reach beyond one half, where no body is possible.
TEST(InputStudy, ARatioNearItsBoundDoesNotMoveTheEstimate) {
  std::vector<std::string> effects = bar_under_gravity(prior(30e3, 3));
  effects[1] = "elasticity: {law: linear, poisson_ratio: 0.495, young_modulus: " + prior(30e3, 3) + "}";
  ModelSettings model = box_settings(effects);
  const TetMesh mesh = bar_mesh();
  const Experiment bar(model, mesh, {kTruth});
  model.exact_inputs = false;
  Estimator estimator(model, mesh);
  step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 40), kNoise, 7));
  const ParameterEstimate& p = estimator.estimate().parameters.front();
  EXPECT_NEAR(p.mean / kTruth, 1.0, 0.03);
  EXPECT_TRUE(holds(p, kTruth));
}

TEST(InputStudy, LeavesTheMisfitOfWhatItDoesNotBelieve) {
  const auto rms_with = [](bool exact) {
    ModelSettings model = pushed();
    model.exact_inputs = exact;
    return estimated(model, [](LoadSample& s) { s.value[2] *= 1.0 + 0.8 * std::sin(40.0 * s.time); });
  };
  const StepResult exact = rms_with(true), uncertain = rms_with(false);
  EXPECT_NE(uncertain.estimate.state, EstimateState::converged) << uncertain.estimate.state_reason;
  EXPECT_GT(uncertain.misfit.rms_sigma, 0.8 * exact.misfit.rms_sigma);
}

TEST(InputStudy, KnowsNothingBeforeItsFirstAnswer) {
  const TetMesh mesh = bar_mesh();
  const ModelSettings model = pushed();
  Experiment bar(model, mesh, {kTruth});
  Estimator estimator(model, mesh);
  estimator.set_first_stamp(0.0);
  load_briefly(bar, estimator);
  const StepResult last = step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 2), kNoise, 7));
  EXPECT_EQ(last.estimate.state, EstimateState::converging);
  EXPECT_GT(std::log(last.estimate.parameters.front().upper95 / last.estimate.parameters.front().lower95), 2.0);
}

TEST(State, IsStaleWhileALoadStaysAway) {
  ModelSettings model = pushed();
  model.stale_after = 0.5;
  const TetMesh mesh = bar_mesh();
  Experiment bar(model, mesh, {kTruth});
  Estimator estimator(model, mesh);
  estimator.set_first_stamp(0.0);
  load_briefly(bar, estimator);
  const StepResult last = step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 60), kNoise, 7));
  EXPECT_EQ(last.estimate.state, EstimateState::stale);
  EXPECT_NE(last.estimate.state_reason.find("/wrench"), std::string::npos) << last.estimate.state_reason;
}

}  // namespace
}  // namespace tissue_stiffness
