// A recording that begins in mid-motion.
#include <gtest/gtest.h>

#include <cmath>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;

std::vector<std::string> pushed_bar(bool in_motion) {
  std::vector<std::string> effects{"inertia: {density: 1000}", modulus(prior(50e3, 3)), "fixed: {region: clamp}",
                                   "viscous_damping: {beta: 3.0e-3}", "traction: {region: tip, topic: /wrench}"};
  if (in_motion) {
    effects.emplace_back(
        "initial_motion: {displacement: {mean: [0, 0, 0], std: 0.01}, velocity: {mean: [0, 0, 0], std: 0.2}, "
        "second_displacement: {mean: [0, 0, 0], std: 0.001}, second_velocity: {mean: [0, 0, 0], std: 0.2}}");
  }
  return effects;
}

StepResult estimated(bool in_motion) {
  Experiment bar(box_settings(pushed_bar(false)), bar_mesh(), {kTruth});
  for (int k = 0; k < 400; ++k) bar.add_load(swaying_wrench(0.005 * k, 9.0, 7.0));
  std::vector<Experiment::Moment> moments = bar.film(0.0, kFilmed, 80);
  moments.erase(moments.begin(), moments.begin() + 30);
  Estimator estimator(box_settings(pushed_bar(in_motion)), bar_mesh());
  estimator.set_first_stamp(moments.front().time);
  for (int k = 0; k < 400; ++k) {
    if (0.005 * k >= moments.front().time - 0.01) estimator.add_load(swaying_wrench(0.005 * k, 9.0, 7.0));
  }
  return step_through(estimator, see_all(bar, moments, kNoise, 3));
}

TEST(InitialMotionEstimate, IsFoundBesideTheModulus) {
  const StepResult last = estimated(true);
  const ParameterEstimate& p = last.estimate.parameters.front();
  std::printf("mid-motion: E %+.2f %% off, 95 %% %+.2f..%+.2f %%, %s\n", 100.0 * (p.mean / kTruth - 1.0),
              100.0 * (p.lower95 / kTruth - 1.0), 100.0 * (p.upper95 / kTruth - 1.0),
              to_string(last.estimate.state).c_str());
  EXPECT_LT(std::abs(p.mean - kTruth), 3.0 * p.std);
  EXPECT_NEAR(p.mean / kTruth, 1.0, 0.005);
  EXPECT_EQ(last.estimate.state, EstimateState::converged);
  EXPECT_LT(last.misfit.rms_sigma, 1.3);
}

TEST(InitialMotionEstimate, WithoutItNothingIsCertain) {
  EXPECT_NE(estimated(false).estimate.state, EstimateState::converged);
}

}  // namespace
}  // namespace tissue_stiffness
