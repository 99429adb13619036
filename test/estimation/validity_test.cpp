#include "estimation/validity.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

Misfit misfit(double rms, double sigma, double motion) {
  Misfit out;
  out.count = 10;
  out.rms = rms;
  out.rms_sigma = rms / sigma;
  out.motion_rms = motion;
  return out;
}

bool invalid(double rms, double sigma, double motion) {
  Validity validity;
  for (int k = 0; k < 20; ++k) validity.add(misfit(rms, sigma, motion));
  return validity.invalid();
}

TEST(Validity, AsksForBothMoreThanNoiseAndAGoodPartOfTheMotion) {
  EXPECT_FALSE(invalid(1e-4, 1e-4, 1e-4));  // noise, however small the motion
  EXPECT_FALSE(invalid(1e-3, 1e-4, 2e-2));  // far above noise, but 5 % of the motion
  EXPECT_TRUE(invalid(1e-3, 1e-4, 2e-3));
}

TEST(Validity, NeedsSomeFramesAndForgetsOldOnes) {
  Validity validity;
  for (int k = 0; k < 3; ++k) validity.add(misfit(1e-3, 1e-4, 2e-3));
  EXPECT_FALSE(validity.invalid());
  for (int k = 0; k < 30; ++k) validity.add(misfit(1e-3, 1e-4, 2e-3));
  EXPECT_TRUE(validity.invalid());
  for (int k = 0; k < 200; ++k) validity.add(misfit(1e-4, 1e-4, 2e-3));
  EXPECT_FALSE(validity.invalid());
  for (int k = 0; k < 200; ++k) validity.add(misfit(1e-3, 1e-4, 2e-3));
  validity.reset();
  EXPECT_FALSE(validity.invalid());
}

TEST(Validity, OfAModelThatLacksThePullOfASecondLoad) {
  std::vector<std::string> truth = bar_under_gravity("20.0e3");
  truth.back() = "gravity: {acceleration: [0, 9, -2]}";
  const Experiment bar(box_settings(truth), bar_mesh(), {});
  std::vector<std::string> effects = bar_under_gravity(prior(20e3, 3));
  effects.back() = "gravity: {acceleration: [0, 0, -2]}";
  Estimator estimator(box_settings(effects), bar_mesh());
  step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 60), kNoise, 1));
  EXPECT_EQ(estimator.estimate().state, EstimateState::model_invalid);
}

}  // namespace
}  // namespace tissue_stiffness
