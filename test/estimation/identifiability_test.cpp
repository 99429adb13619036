// Theory says what the data determine: (E, density, loads) rescale together.
#include <gtest/gtest.h>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

const std::string kFixed = "fixed: {region: clamp}", kGravity = "gravity: {acceleration: [0.5, 1, -3]}",
                  kPushed = "traction: {region: tip, topic: /wrench}",
                  kUnknownDensity = "inertia: {density: " + prior(1000, 2) + "}";

// Returns the verdicts after a recording whose truth is every parameter's prior. The bar is pushed when the model asks for
// it.
std::map<std::string, Identifiability> verdicts(const std::vector<std::string>& effects, int frames = 25) {
  const TetMesh mesh = bar_mesh();
  const ModelSettings settings = box_settings(effects);
  Experiment bar(settings, mesh, {});
  Estimator estimator(settings, mesh);
  estimator.set_first_stamp(0.0);
  for (int k = 0; k < 50 && !estimator.load_inputs().empty(); ++k) {
    LoadSample sample{"/wrench", 0.01 * k, Eigen::VectorXd::Zero(6)};
    sample.value[2] = 0.01 * std::sin(12.0 * sample.time);
    bar.add_load(sample);
    estimator.add_load(sample);
  }
  step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, frames), kNoise, 1));
  return estimator.identifiability();
}

void expect(const std::map<std::string, Identifiability>& found, const std::string& name, const std::string& verdict,
            const std::string& reason) {
  ASSERT_EQ(found.count(name), 1U) << name;
  EXPECT_EQ(found.at(name).verdict, verdict) << name << ": " << found.at(name).reason;
  EXPECT_NE(found.at(name).reason.find(reason), std::string::npos) << found.at(name).reason;
}

TEST(Identifiability, GravityAloneGivesModulusOverDensity) {
  const auto found = verdicts({kUnknownDensity, modulus(prior(30e3, 2)), kFixed, kGravity});
  expect(found, "elasticity.young_modulus", "ratio_only", "scale");
  expect(found, "inertia.density", "ratio_only", "scale");
}

TEST(Identifiability, TheRatioStaysARatioWhenOnePriorIsNarrow) {
  const auto found = verdicts({"inertia: {density: " + prior(1000, 1.2) + "}", modulus(prior(30e3, 4)), kFixed, kGravity});
  expect(found, "elasticity.young_modulus", "ratio_only", "scale");
  expect(found, "inertia.density", "ratio_only", "scale");
}

TEST(Identifiability, AKnownDensityMakesTheModulusAbsolute) {
  const auto found = verdicts({"inertia: {density: 1000}", modulus(prior(30e3, 2)), kFixed, kGravity});
  expect(found, "elasticity.young_modulus", "absolute", "inertia.density");
}

TEST(Identifiability, AMeasuredTractionMakesBothAbsolute) {
  const auto found = verdicts({kUnknownDensity, modulus(prior(30e3, 2)), kFixed, kPushed});
  expect(found, "elasticity.young_modulus", "absolute", "traction");
  expect(found, "inertia.density", "absolute", "traction");
}

TEST(Identifiability, AnUnknownScaleOfTheTractionTakesTheForceAway) {
  const auto found = verdicts({kUnknownDensity, modulus(prior(30e3, 2)), kFixed,
                               "traction: {region: tip, topic: /wrench, scale: " + prior(1, 2) + "}"});
  expect(found, "elasticity.young_modulus", "ratio_only", "scale");
  expect(found, "traction.scale", "ratio_only", "scale");
}

TEST(Identifiability, ARegionThatNothingMovesHasNoModulus) {
  std::vector<std::string> effects{"inertia: {density: 1000}", modulus(prior(30e3, 2), "near"),
                                   modulus(prior(30e3, 2), "far"), "fixed: {region: near}", kGravity};
  const auto found = verdicts(effects);
  expect(found, "elasticity.young_modulus", "none", "prior");
  expect(found, "elasticity#2.young_modulus", "absolute", "inertia.density");
}

TEST(Identifiability, DampingIsNoScale) {
  const auto found = verdicts(
      {kUnknownDensity, modulus(prior(30e3, 2)), kFixed, kGravity, "viscous_damping: {beta: " + prior(4e-3, 3) + "}"});
  expect(found, "elasticity.young_modulus", "ratio_only", "scale");
  expect(found, "viscous_damping.beta", "absolute", "no scale");
}

TEST(Identifiability, NothingIsKnownBeforeTheFirstMotion) {
  const auto found = verdicts({"inertia: {density: 1000}", modulus(prior(30e3, 2)), kFixed, kGravity}, 1);
  expect(found, "elasticity.young_modulus", "none", "prior");
}

}  // namespace
}  // namespace tissue_stiffness
