// Recordings of a bar with something hidden: the diagnosis names it, proves it, and is silent where nothing is.
#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../box_model.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3, kNoise = 1e-4;

std::vector<std::string> bar(const std::string& modulus) {
  return {"inertia: {density: 1000}", "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + modulus + "}",
          "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -3]}"};
}

Recording film(const std::vector<std::string>& hidden, unsigned seed) {
  std::vector<std::string> effects = bar("{prior: 20.0e3, factor: 3}");
  effects.insert(effects.end(), hidden.begin(), hidden.end());
  const Experiment experiment(box_settings(effects), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), kNoise, seed);
  return recording;
}

Diagnosis diagnose_bar(const Recording& recording, const DiagnosisOptions& options) {
  return diagnose(box_settings(bar("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording, options);
}

TEST(Diagnose, FindsNothingWhereNothingIsMissing) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Diagnosis d = diagnose_bar(film({}, seed), {});
    EXPECT_EQ(d.verdict, "adequate") << seed;
    EXPECT_TRUE(d.set.empty());
    EXPECT_NEAR(d.steps.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.01);
  }
}

TEST(Diagnose, NamesHiddenDampingAndAddsIt) {
  DiagnosisOptions options;
  options.automatic = true;
  const Diagnosis d = diagnose_bar(film({"viscous_damping: {beta: 6.0e-3}"}, 1), options);
  EXPECT_EQ(d.verdict, "missing");
  EXPECT_NE(std::find(d.set.begin(), d.set.end(), "viscous_damping"), d.set.end());
  ASSERT_GE(d.steps.size(), 2U);
  EXPECT_LT(d.steps.back().held_out_rms, 0.2 * d.steps.front().held_out_rms);
  EXPECT_LT(d.steps.back().held_out_rms, 1.1 * d.steps.back().noise_floor);
  EXPECT_NEAR(d.steps.back().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.02);
  EXPECT_EQ(d.final_verdict, "adequate");
}

TEST(Diagnose, AddsWhatItIsTold) {
  DiagnosisOptions options;
  options.add = {"mass_damping"};
  const Diagnosis d = diagnose_bar(film({"mass_damping: {alpha: 1.5}"}, 2), options);
  EXPECT_EQ(d.final_effects, options.add);
  ASSERT_EQ(d.steps.size(), 2U);
  EXPECT_NEAR(d.steps.back().parameters.at("mass_damping.alpha"), 1.5, 0.15);
  options.add = {"pressure"};
  EXPECT_NE(refusal([&] { diagnose_bar(film({}, 1), options); }).find("--add"), std::string::npos);
}

TEST(Diagnose, RefusesARecordingTooShortToHoldAnythingOut) {
  Recording recording = film({}, 1);
  recording.frames.resize(10);
  EXPECT_NE(refusal([&] { diagnose_bar(recording, {}); }).find("10 usable frames"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
