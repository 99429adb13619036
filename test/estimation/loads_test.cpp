// Measured loads may arrive in any order: the body feels them at their own time.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;

const std::vector<std::string> kPushed{"inertia: {density: 1000}", modulus(prior(60e3, 3)), "fixed: {region: clamp}",
                                       "traction: {region: tip, topic: /wrench}"};

// Returns samples every 7 ms, not at the frames' instants.
std::vector<LoadSample> wrenches() {
  std::vector<LoadSample> samples;
  for (int k = 0; k < 70; ++k) {
    LoadSample sample{"/wrench", 0.007 * k, Eigen::VectorXd::Zero(6)};
    sample.value[1] = 4e-3 * std::sin(6.0 * sample.time);
    sample.value[2] = 6e-3 * std::sin(15.0 * sample.time);
    samples.push_back(sample);
  }
  return samples;
}

std::vector<Frame> recording() {
  Experiment bar(box_settings(kPushed), bar_mesh(), {kTruth});
  for (const LoadSample& sample : wrenches()) bar.add_load(sample);
  return see_all(bar, bar.film(0.0, kFilmed, 22), kNoise, 1);
}

std::string in_order(const std::vector<Frame>& frames) {
  Estimator estimator(box_settings(kPushed), bar_mesh());
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : wrenches()) estimator.add_load(sample);
  step_through(estimator, frames);
  EXPECT_TRUE(holds(estimator.estimate().parameters.front(), kTruth));
  return bytes(estimator);
}

TEST(Loads, AreAskedForByTopic) {
  const Estimator estimator(box_settings(kPushed), bar_mesh());
  ASSERT_EQ(estimator.load_inputs().size(), 1U);
  EXPECT_EQ(estimator.load_inputs()[0].topic, "/wrench");
  EXPECT_EQ(estimator.load_inputs()[0].kind, LoadInput::Kind::wrench);
}

// The wrench is not known from 0.2 to 0.3 s: the model would hold it, and take the motion for the body's.
TEST(Loads, ThatAreSilentLeaveOutTheFrames) {
  const std::vector<Frame> frames = recording();
  Estimator estimator(box_settings(kPushed), bar_mesh());
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : wrenches()) {
    if (sample.time < 0.2 || sample.time > 0.3) estimator.add_load(sample);
  }
  int left_out = 0;
  for (const Frame& frame : frames) {
    const StepResult result = estimator.step(frame);
    EXPECT_EQ(result.used, frame.time < 0.196 + 5 * 0.007 || frame.time > 0.301) << frame.time << " s: " << result.reason;
    if (result.used) continue;
    ++left_out;
    EXPECT_EQ(result.reason.find("no load on /wrench for 0."), 0U) << result.reason;
    EXPECT_NE(result.estimate.state, EstimateState::stale);
  }
  EXPECT_EQ(left_out, 4);
  EXPECT_TRUE(holds(estimator.estimate().parameters.front(), kTruth));
}

TEST(Observations, ThatComeTwiceCountOnce) {
  const std::vector<Frame> frames = recording();
  Estimator estimator(box_settings(kPushed), bar_mesh());
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : wrenches()) estimator.add_load(sample);
  for (Frame frame : frames) {
    frame.observations.push_back(frame.observations.front());
    EXPECT_EQ(estimator.step(frame).repeated, 1);
  }
  EXPECT_TRUE(bytes(estimator) == in_order(frames));
}

TEST(Loads, OutOfOrderGiveTheSameResult) {
  const std::vector<Frame> frames = recording();
  std::vector<LoadSample> samples = wrenches();
  std::shuffle(samples.begin(), samples.end(), std::mt19937(5));
  Estimator estimator(box_settings(kPushed), bar_mesh());
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : samples) estimator.add_load(sample);
  estimator.add_load(samples.front());  // and one sample twice
  step_through(estimator, frames);
  EXPECT_TRUE(bytes(estimator) == in_order(frames));
}

TEST(Loads, AsLateAsTheFrameThatNeedsThemGiveTheSameResult) {
  const std::vector<Frame> frames = recording();
  const std::vector<LoadSample> samples = wrenches();
  Estimator estimator(box_settings(kPushed), bar_mesh());
  estimator.set_first_stamp(0.0);
  auto fed = samples.begin();
  for (const Frame& frame : frames) {
    auto end = std::find_if(fed, samples.end(), [&](const LoadSample& sample) { return sample.time >= frame.time; });
    if (end != samples.end()) ++end;  // the sample behind the frame, to interpolate
    std::for_each(std::make_reverse_iterator(end), std::make_reverse_iterator(fed),
                  [&](const LoadSample& sample) { estimator.add_load(sample); });
    fed = end;
    estimator.step(frame);
  }
  EXPECT_TRUE(bytes(estimator) == in_order(frames));
}

TEST(Loads, BeforeTheFirstFrameSetTheRecordingsFirstStamp) {
  const std::vector<Frame> frames = recording();
  Estimator estimator(box_settings(kPushed), bar_mesh());
  for (const LoadSample& sample : wrenches()) estimator.add_load(sample);
  const StepResult last =
      step_through(estimator, {frames.begin() + 3, frames.end()});  // pushed since 0 s, seen since 0.06 s
  EXPECT_NEAR(last.misfit.rms_sigma, 1.0, 0.2);
  EXPECT_LT(last.estimate.parameters.front().std / kTruth, 0.01);
  EXPECT_TRUE(holds(estimator.estimate().parameters.front(), kTruth));
}

TEST(Loads, ThatAreNoneAreRefusedAndChangeNothing) {
  const std::vector<Frame> frames = recording();
  Estimator estimator(box_settings(kPushed), bar_mesh());
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : wrenches()) estimator.add_load(sample);
  LoadSample bad{"/wrench", 0.1, Eigen::VectorXd::Constant(6, std::nan(""))};
  EXPECT_NE(refusal([&] { estimator.add_load(bad); }).find("6 finite"), std::string::npos);
  bad.value = Eigen::VectorXd::Zero(1);
  EXPECT_NE(refusal([&] { estimator.add_load(bad); }).find("wrong size"), std::string::npos);
  bad = {"/wrench", std::nan(""), Eigen::VectorXd::Zero(6)};
  EXPECT_NE(refusal([&] { estimator.add_load(bad); }).find("time"), std::string::npos);
  estimator.add_load({"/elsewhere", 0.1, Eigen::VectorXd::Ones(6)});  // nobody asked for it
  step_through(estimator, frames);
  EXPECT_TRUE(bytes(estimator) == in_order(frames));
}

// A broken force sensor gives a spike, a million times too large, and no free run gets past it.
TEST(Loads, ThatTheModelCannotFollowAreReportedAndSurvived) {
  std::vector<std::string> effects = kPushed;
  effects[1] = "elasticity: {law: neo_hookean, poisson_ratio: 0.4, young_modulus: " + prior(20e3, 1.5) + "}";
  const ModelSettings settings = box_settings(effects);
  const TetMesh mesh = bar_mesh(2);
  Experiment bar(settings, mesh, {kTruth});
  Estimator estimator(settings, mesh);
  for (LoadSample sample : wrenches()) {
    bar.add_load(sample);
    if (sample.time > 0.1 && sample.time < 0.11) sample.value *= 1e6;
    estimator.add_load(sample);
  }
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 10), kNoise, 1);
  step_through(estimator, {frames.begin(), frames.begin() + 5});  // to 0.08 s
  const double before = value(estimator);
  for (std::size_t k = 5; k < frames.size(); ++k) {
    const StepResult step = estimator.step(frames[k]);
    EXPECT_FALSE(step.used);
    EXPECT_NE(step.reason.find("inside out"), std::string::npos) << step.reason;
    EXPECT_EQ(value(estimator), before);
  }
  estimator.reset();
  for (const LoadSample& sample : wrenches()) estimator.add_load(sample);
  const StepResult last = step_through(estimator, frames);
  EXPECT_TRUE(last.used) << last.reason;
  EXPECT_NEAR(value(estimator) / kTruth, 1.0, 0.05);
}

}  // namespace
}  // namespace tissue_stiffness
