// Several recordings of one body: what they share counts once, and what each has for itself is its own.
#include "estimation/joint_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3;
constexpr int kFrames = 60;

using Change = std::function<void(LoadSample&)>;

// A bar that a measured wrench pushes; with `keys` of the load.
ModelSettings pushed(const std::string& keys = "", const std::string& density = "1000") {
  ModelSettings model =
      box_settings({"inertia: {density: " + density + "}", modulus(prior(30e3, 3)), "fixed: {region: clamp}",
                    "viscous_damping: {beta: 4.0e-3}", "traction: {region: tip, topic: /wrench" + keys + "}"});
  model.exact_inputs = false;
  return model;
}

ModelSettings dropped(const std::string& young_modulus = prior(30e3, 3)) {
  return box_settings(bar_under_gravity(young_modulus));
}

// Films a bar of the given modulus, whose wrench is recorded with an error.
BodyRecording film(
    const std::string& name, const ModelSettings& model, double young_modulus, unsigned seed, double rate = 4.0,
    const Change& error = [](LoadSample&) {}, double noise = kNoise) {
  BodyRecording out;
  out.name = name;
  out.settings = model;
  out.mesh = bar_mesh();
  Experiment bar(model, out.mesh, {young_modulus});
  for (int k = 0; k < 260 && !bar.model().loads().inputs().empty(); ++k) {
    LoadSample sample = swaying_wrench(0.005 * k, 1.5 * rate, rate);
    bar.add_load(sample);
    error(sample);
    out.recording.loads.push_back(sample);
  }
  out.recording.frames = see_all(bar, bar.film(0.0, kFilmed, kFrames), noise, seed);
  return out;
}

JointEstimate jointly(const std::vector<BodyRecording>& recordings, const std::vector<std::string>& own = {}) {
  return estimate_jointly(recordings, own, [](const std::string&, std::size_t, std::size_t) {});
}

double relative_std(const ParameterEstimate& p) {
  return p.std / p.mean;
}

TEST(JointEstimate, OfOneRecordingIsTheEstimators) {
  ModelSettings coarse = dropped();  // its mesh counts, and shifts the estimate
  coarse.mesh.discretisation_error = true;
  for (const ModelSettings& model : {pushed(), dropped(), coarse}) {
    const BodyRecording one = film("a", model, kTruth, 7);
    Estimator estimator(one.settings, one.mesh);
    estimator.set_first_stamp(0.0);
    for (const LoadSample& load : one.recording.loads) estimator.add_load(load);
    estimator.replay(one.recording.frames);
    const ParameterEstimate& alone = estimator.estimate().parameters.front();
    const JointEstimate joint = jointly({one});
    const ParameterEstimate& found = joint.estimate.parameters.front();
    std::printf("alone %.0f -+ %.0f Pa, jointly %.0f -+ %.0f\n", alone.mean, alone.std, found.mean, found.std);
    EXPECT_NEAR(found.mean, alone.mean, 0.1 * alone.std);
    EXPECT_NEAR(found.std, alone.std, 0.1 * alone.std);
    EXPECT_EQ(joint.estimate.state, EstimateState::converged) << joint.estimate.state_reason;
  }
}

// With exact inputs noise alone is left, and it averages out.
TEST(JointEstimate, AveragesTheNoise) {
  std::vector<BodyRecording> recordings;
  for (unsigned seed = 1; seed <= 4; ++seed) recordings.push_back(film(std::to_string(seed), dropped(), kTruth, seed));
  const ParameterEstimate one = jointly({recordings[0]}).estimate.parameters.front();
  const ParameterEstimate all = jointly(recordings).estimate.parameters.front();
  std::printf("one %.4f %%, four %.4f %%\n", 100.0 * relative_std(one), 100.0 * relative_std(all));
  EXPECT_NEAR(relative_std(one) / relative_std(all), 2.0, 0.4);
  EXPECT_TRUE(holds(all, kTruth));
}

// The gain of one sensor is wrong by the same share in every recording. A body without mass tells E over the gain only.
TEST(JointEstimate, DoesNotAverageTheGainOfOneSensor) {
  const std::string only_gain = ", gain: 0.1, bias: 0, hysteresis: 0, delay: 0, direction: 0, noise: 0";
  std::vector<BodyRecording> recordings;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    recordings.push_back(film(std::to_string(seed), pushed(only_gain, "10"), kTruth, seed, 3.0 + seed,
                              [](LoadSample& s) { s.value *= 1.12; }));
  }
  const ParameterEstimate one = jointly({recordings[0]}).estimate.parameters.front();
  const ParameterEstimate all = jointly(recordings).estimate.parameters.front();
  const ParameterEstimate apart = jointly(recordings, {"/wrench"}).estimate.parameters.front();
  std::printf("one %.2f %%, four %.2f %%, with four sensors %.2f %%\n", 100.0 * relative_std(one),
              100.0 * relative_std(all), 100.0 * relative_std(apart));
  EXPECT_TRUE(holds(all, kTruth)) << all.lower95 << " to " << all.upper95;
  EXPECT_LT(relative_std(all), 1.05 * relative_std(one));
  EXPECT_LT(relative_std(apart), 0.8 * relative_std(all));
}

// Noise of 10 m hides everything.
TEST(JointEstimate, CountsThePriorOnce) {
  ModelSettings blind = dropped();
  blind.observations.front().noise = 10.0;
  const ParameterEstimate found =
      jointly({film("a", blind, kTruth, 1), film("b", blind, kTruth, 2)}).estimate.parameters.front();
  EXPECT_NEAR(std::log(found.upper95 / found.lower95), 2.0 * 1.96 * std::log(3.0), 0.05);
}

TEST(JointEstimate, ForetellsTheSameBodyAndNoOther) {
  const BodyRecording a = film("a", pushed(), kTruth, 1, 4.0), b = film("b", pushed(), kTruth, 2, 6.0);
  BodyRecording same = film("same", pushed(), kTruth, 3, 5.0), other = film("other", pushed(), 2.0 * kTruth, 4, 5.0);
  same.predicted = other.predicted = true;
  const JointEstimate without = jointly({a, b}), joint = jointly({a, b, same, other});
  EXPECT_NEAR(joint.estimate.parameters.front().mean, without.estimate.parameters.front().mean,
              1e-6 * without.estimate.parameters.front().mean);
  const RecordingSummary &foretold = joint.recordings[2], &missed = joint.recordings[3];
  std::printf("same: %.3g mm, %.3g sigma, agreement %.2g; other: %.3g mm, agreement %.2g\n", 1e3 * foretold.rms_error,
              foretold.rms_sigma, foretold.agreement.z(), 1e3 * missed.rms_error, missed.agreement.z());
  EXPECT_NEAR(foretold.rms_sigma, 1.0, 0.3);
  EXPECT_TRUE(foretold.agreement.passes());
  EXPECT_TRUE(foretold.test.passes());
  EXPECT_GT(missed.rms_error, 5.0 * foretold.rms_error);
  EXPECT_FALSE(missed.agreement.passes());
}

TEST(JointEstimate, DoubtsRecordingsOfDifferentBodies) {
  const JointEstimate joint = jointly({film("a", dropped(), kTruth, 1), film("b", dropped(), 1.1 * kTruth, 2)});
  EXPECT_NE(joint.estimate.state, EstimateState::converged);
  const ParameterEstimate& found = joint.estimate.parameters.front();
  EXPECT_TRUE(holds(found, kTruth) && holds(found, 1.1 * kTruth)) << found.lower95 << " to " << found.upper95;
}

// What one of two moduli does is seen in one recording only, and its own parameter stays its own.
TEST(JointEstimate, KeepsOwnParametersApart) {
  const std::vector<BodyRecording> recordings{film("a", dropped(), kTruth, 1), film("b", dropped(), 1.5 * kTruth, 2)};
  const JointEstimate joint = jointly(recordings, {"elasticity"});
  ASSERT_EQ(joint.estimate.parameters.size(), 2u);
  EXPECT_EQ(joint.recording, (std::vector<int>{0, 1}));
  for (std::size_t r = 0; r < 2; ++r) {
    const ParameterEstimate &found = joint.estimate.parameters[r], &alone = joint.recordings[r].alone.parameters[0];
    EXPECT_NEAR(found.mean, alone.mean, 0.1 * alone.std);
    EXPECT_NEAR(found.std, alone.std, 0.1 * alone.std);
  }
  EXPECT_EQ(joint.estimate.state, EstimateState::converged) << joint.estimate.state_reason;
}

TEST(JointEstimate, RefusesWhatDoesNotFitTogether) {
  const BodyRecording a = film("a", dropped(), kTruth, 1), b = film("b", dropped(prior(50e3, 2)), kTruth, 2);
  const std::string priors = refusal([&] { jointly({a, b}); });
  EXPECT_NE(priors.find("b: prior of elasticity.young_modulus: found 50000 Pa, factor 2"), std::string::npos) << priors;
  const std::string name = refusal([&] { jointly({a, a}, {"gravity"}); });
  EXPECT_NE(name.find("--own: found gravity"), std::string::npos) << name;
}

}  // namespace
}  // namespace tissue_stiffness
