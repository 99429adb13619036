// Limits of the states may change between frames: the state follows, and the estimate goes on.
#include <gtest/gtest.h>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3;

TEST(StateLimits, JudgeLaterFramesAndLoseNoEstimate) {
  const TetMesh mesh = bar_mesh();
  const Experiment bar(box_settings(bar_under_gravity(prior(kTruth, 3))), mesh, {kTruth});
  std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 100), kNoise, 4);
  const std::vector<Frame> last(frames.end() - 2, frames.end());
  frames.resize(frames.size() - 2);
  Estimator estimator(box_settings(bar_under_gravity(prior(2.0 * kTruth, 3))), mesh);
  const Estimate before = step_through(estimator, frames).estimate;
  ASSERT_EQ(before.state, EstimateState::converged) << before.state_reason;
  StateLimits limits;
  limits.converged_within = 0.5 * before.parameters.front().std / before.parameters.front().mean;
  estimator.set_state_limits(limits);
  EXPECT_EQ(estimator.estimate().state, EstimateState::converged) << "no frame has come since";
  const Estimate strict = estimator.step(last[0]).estimate;
  EXPECT_EQ(strict.state, EstimateState::converging);
  EXPECT_NE(strict.state_reason.find("is known to"), std::string::npos) << strict.state_reason;
  EXPECT_NEAR(strict.parameters.front().mean, before.parameters.front().mean, 3.0 * before.parameters.front().std);
  EXPECT_LE(strict.parameters.front().std, 1.01 * before.parameters.front().std);
  estimator.set_state_limits({});
  const Estimate after = estimator.step(last[1]).estimate;
  EXPECT_EQ(after.state, EstimateState::converged) << after.state_reason;
}

// Returns the state 0.9 s after the last load, of a model whose own limit is 2 s.
EstimateState state_without_load(double stale_after) {
  const ModelSettings model = box_settings({"inertia: {density: 1000}", modulus(prior(30e3, 3)), "fixed: {region: clamp}",
                                            "viscous_damping: {beta: 4.0e-3}", "traction: {region: tip, topic: /wrench}"});
  const TetMesh mesh = bar_mesh();
  Experiment bar(model, mesh, {kTruth});
  Estimator estimator(model, mesh);
  estimator.set_first_stamp(0.0);
  load_briefly(bar, estimator);
  StateLimits limits;
  limits.stale_after = stale_after;
  estimator.set_state_limits(limits);
  return step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 60), kNoise, 7)).estimate.state;
}

TEST(StateLimits, SetHowLongALoadMayStayAway) {
  EXPECT_EQ(state_without_load(0.5), EstimateState::stale);
  EXPECT_NE(state_without_load(1.0), EstimateState::stale);
}

}  // namespace
}  // namespace tissue_stiffness
