// Long work runs in the background: no frame waits for it, and the estimate does not change.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "../processor_time.hpp"
#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;
constexpr int kFrames = 120;
constexpr std::size_t kBetween = 10;

const std::vector<std::string> kPulled{"inertia: {density: 1000}", modulus(prior(12e3, 3)), "fixed: {region: clamp}",
                                       "gravity: {acceleration: [0.5, 1, -3]}", "traction: {region: tip, topic: /wrench}"};

LoadSample wrench(double time) {
  LoadSample sample{"/wrench", time, Eigen::VectorXd::Zero(6)};
  sample.value[2] = 5e-3 * std::sin(15.0 * time);
  return sample;
}

std::vector<Frame> recording() {
  Experiment bar(box_settings(kPulled), bar_mesh(), {kTruth});
  for (int k = 0; k <= kFrames; ++k) bar.add_load(wrench(kFilmed * k));
  return see_all(bar, bar.film(0.0, kFilmed, kFrames), kNoise, 1);
}

/// Takes what the background has to tell until it has nothing to do. Returns the last result; empty: there was none.
std::optional<StepResult> finish_background(Estimator& estimator) {
  std::optional<StepResult> last;
  while (estimator.reprocesses()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (auto result = estimator.catch_up()) last = std::move(result);
  }
  return last;
}

/// Loads come with the frames, as in a live run. `between`: frames that come while the background works before it is waited
/// for; 0: nobody waits.
StepResult step_with_loads(Estimator& estimator, const std::vector<Frame>& frames, std::size_t between = 0) {
  estimator.set_first_stamp(0.0);
  estimator.add_load(wrench(0.0));
  StepResult last;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (between > 0 && k % between == 0) finish_background(estimator);
    estimator.add_load(wrench(frames[k].time));
    last = estimator.step(frames[k]);
    EXPECT_TRUE(last.used) << last.reason;
  }
  return last;
}

ParameterEstimate estimated_at_once(const std::vector<Frame>& frames) {
  Estimator waiting(box_settings(kPulled), bar_mesh());
  return step_with_loads(waiting, frames).estimate.parameters.front();
}

/// Returns the processor time [s] that the calling thread spends on all frames. All loads are known before.
double spent_on(Estimator& estimator, const std::vector<Frame>& frames) {
  estimator.set_first_stamp(0.0);
  for (int k = 0; k <= kFrames; ++k) estimator.add_load(wrench(kFilmed * k));
  const double start = processor_seconds();
  for (const Frame& frame : frames) estimator.step(frame);
  return processor_seconds() - start;
}

TEST(Background, ComesToTheSameEstimate) {
  const std::vector<Frame> frames = recording();
  const ParameterEstimate at_once = estimated_at_once(frames);
  Estimator estimator(box_settings(kPulled), bar_mesh());
  estimator.work_in_background();
  StepResult last = step_with_loads(estimator, frames, kBetween);
  if (const auto result = finish_background(estimator)) last = *result;
  const ParameterEstimate& beside = last.estimate.parameters.front();
  EXPECT_NEAR(beside.mean, at_once.mean, 0.3 * at_once.std);
  EXPECT_NEAR(beside.std, at_once.std, 0.3 * at_once.std);
  EXPECT_EQ(last.estimate.state, EstimateState::converged);
  EXPECT_LT(last.misfit.rms_sigma, 1.2);
}

TEST(Background, CatchesUpAfterTheLastFrame) {
  const std::vector<Frame> frames = recording();
  const ParameterEstimate at_once = estimated_at_once(frames);
  std::unique_ptr<Estimator> running;
  StepResult last;
  for (int k = 0; k < 10 && !(running && running->reprocesses()); ++k) {  // now and then the reprocessing ends in time
    running = std::make_unique<Estimator>(box_settings(kPulled), bar_mesh());
    running->work_in_background();
    last = step_with_loads(*running, frames);
  }
  Estimator& estimator = *running;
  const double time = last.estimate.time;
  EXPECT_TRUE(estimator.reprocesses());
  if (const auto result = finish_background(estimator)) last = *result;
  EXPECT_FALSE(estimator.reprocesses());
  EXPECT_EQ(last.estimate.time, time);
  EXPECT_NEAR(last.estimate.parameters.front().mean, at_once.mean, 0.3 * at_once.std);
  EXPECT_NEAR(value(estimator), at_once.mean, 0.3 * at_once.std);
  EXPECT_FALSE(estimator.catch_up());
}

TEST(Background, HoldsUpNoFrame) {
  const std::vector<Frame> frames = recording();
  Estimator estimator(box_settings(kPulled), bar_mesh()), waiting(box_settings(kPulled), bar_mesh());
  estimator.work_in_background();
  const double beside = spent_on(estimator, frames), at_once = spent_on(waiting, frames);
  std::printf("processor time of the frames: %.2f ms with reprocessing in the background, %.2f ms with them at once\n",
              1e3 * beside, 1e3 * at_once);
  EXPECT_LT(beside, 0.5 * at_once);
}

TEST(Background, IsGivenUpByAReset) {
  const std::vector<Frame> frames = recording();
  Estimator estimator(box_settings(kPulled), bar_mesh());
  estimator.work_in_background();
  step_with_loads(estimator, {frames.begin(), frames.begin() + 40});
  estimator.reset();
  EXPECT_EQ(estimator.estimate().state, EstimateState::no_data);
  const StepResult last = step_with_loads(estimator, frames, kBetween);
  EXPECT_TRUE(holds(last.estimate.parameters.front(), kTruth));
}

}  // namespace
}  // namespace tissue_stiffness
