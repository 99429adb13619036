// A modulus that jumps or drifts while the body moves is followed, and the state says when not to trust it.
#include <gtest/gtest.h>

#include <functional>

#include "bar.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;
constexpr double kRate = 1.0 / 30.0;  // [s] between frames
constexpr int kFrames = 90;

ModelSettings drifting(const std::string& drift, double start = 45e3) {
  return box_settings(bar_under_gravity("{prior: " + std::to_string(start) + ", factor: 3" +
                                        (drift.empty() ? "" : ", drift: " + drift) + "}"));
}

/// Films a bar under gravity whose modulus is `course` of the time, piecewise constant between `steps` instants a frame.
std::vector<Frame> film(const std::function<double(double)>& course, int steps, unsigned seed, int frames = kFrames) {
  const Experiment bar(drifting(""), bar_mesh(), {course(0.0)});
  const ReducedModel runs(bar.model());
  const auto theta = [&](double time) {
    return bar.model().parameters().theta(Eigen::VectorXd::Constant(1, std::log(course(time))));
  };
  std::unique_ptr<Trajectory> run = runs.start(theta(0.0), 0.0);
  std::vector<Experiment::Moment> moments;
  for (int k = 0; k < steps * frames; ++k) {
    const double time = kRate * k / steps;
    run->advance(time);
    run = runs.resume(theta(time + 0.5 * kRate / steps), *run);
    if (k % steps == 0) moments.push_back({time, run->displacement()});
  }
  return see_all(bar, moments, kNoise, seed);
}

std::function<double(double)> jump(double time, double factor) {
  return [=](double t) { return t < time ? kTruth : factor * kTruth; };
}

TEST(Change, AJumpIsFollowedWithinASecond) {
  for (const double factor : {2.0, 0.5, 1.1}) {
    const double when = 1.5 + 0.3 * kRate;  // between frames
    const std::vector<Frame> frames = film(jump(when, factor), 10, 3);
    Estimator estimator(drifting("0.3"), bar_mesh());
    double last_wrong = 0.0, noticed = 0.0;
    for (const Frame& frame : frames) {
      const StepResult result = estimator.step(frame);
      ASSERT_TRUE(result.used) << result.reason;
      const double truth = frame.time < when ? kTruth : factor * kTruth;
      const bool trusted = result.estimate.state == EstimateState::converged;
      if (frame.time > when && std::abs(value(estimator) / truth - 1.0) > 0.02) last_wrong = frame.time - when;
      if (frame.time > when && result.estimate.state == EstimateState::drifting && noticed == 0.0)
        noticed = frame.time - when;
      EXPECT_TRUE(trusted || frame.time < 1.0 || frame.time > when);
    }
    std::printf("E x%g: drifting after %.2f s, within 2 %% after %.2f s, %+.3f %% off at the end\n", factor, noticed,
                last_wrong, 100.0 * (value(estimator) / (factor * kTruth) - 1.0));
    EXPECT_GT(noticed, 0.0);
    EXPECT_LT(last_wrong, 1.0);
    EXPECT_TRUE(holds(estimator.estimate().parameters.front(), factor * kTruth));
    EXPECT_EQ(estimator.estimate().state, EstimateState::converged);
    const std::vector<Misfit> misfits = estimator.free_run();
    EXPECT_EQ(misfits.size(), frames.size());
    for (const Misfit& misfit : misfits) EXPECT_LT(misfit.rms_sigma, 1.5) << "at " << misfit.time;
  }
}

TEST(Change, ADriftIsFollowed) {
  const std::vector<Frame> frames = film([](double t) { return kTruth * std::exp(-0.2 * t); }, 10, 3);
  Estimator estimator(drifting("0.1"), bar_mesh());
  double worst = 0.0;
  for (const Frame& frame : frames) {
    estimator.step(frame);
    const double truth = kTruth * std::exp(-0.2 * frame.time);
    if (frame.time > 1.0) worst = std::max(worst, std::abs(value(estimator) / truth - 1.0));
  }
  std::printf("20 %% a second: at most %.2f %% behind\n", 100.0 * worst);
  EXPECT_LT(worst, 0.08);
}

TEST(Change, NoneIsSeenWhereThereIsNone) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const std::vector<Frame> frames = film(jump(1e9, 1.0), 1, seed);
    Estimator constant(drifting(""), bar_mesh()), free(drifting("0.3"), bar_mesh());
    for (const Frame& frame : frames) {
      constant.step(frame);
      EXPECT_NE(free.step(frame).estimate.state, EstimateState::drifting);
    }
    EXPECT_EQ(value(free), value(constant));
  }
}

TEST(Change, IsNotFollowedByAConstantModulus) {
  const std::vector<Frame> frames = film(jump(1.5, 2.0), 1, 3);
  Estimator estimator(drifting(""), bar_mesh());
  EXPECT_EQ(step_through(estimator, frames).estimate.state, EstimateState::model_invalid);
}

TEST(Change, ANegativeRateIsRefused) {
  EXPECT_NE(refusal([] { Estimator(drifting("-1"), bar_mesh()); }).find("drift"), std::string::npos);
}

// The window holds 100 frames, and the bar is filmed for four times as long. Its phase since the start is then told less
// well.
TEST(Window, LeavesOldFramesBehindButNotWhatTheyTold) {
  const std::vector<Frame> frames = film(jump(1e9, 1.0), 1, 5, 400);
  ModelSettings settings = drifting("");
  Estimator all(settings, bar_mesh());
  step_through(all, frames);
  settings.window = 100;
  Estimator some(settings, bar_mesh());
  step_through(some, frames);
  EXPECT_TRUE(holds(some.estimate().parameters.front(), kTruth));
  EXPECT_NEAR(value(some) / value(all), 1.0, 2e-4);
  EXPECT_LT(some.estimate().parameters.front().std, 4.0 * all.estimate().parameters.front().std);
  const std::vector<Misfit> free = some.free_run();
  EXPECT_GE(free.size(), 50U);
  EXPECT_LE(free.size(), 101U);
  double square = 0.0;
  for (const Misfit& misfit : free) square += misfit.rms_sigma * misfit.rms_sigma / static_cast<double>(free.size());
  EXPECT_NEAR(square, 1.0, 0.05);
}

TEST(Window, AJumpIsFollowedLongAfterTheBeginning) {
  const double when = 270.3 * kRate;
  const std::vector<Frame> frames = film(jump(when, 2.0), 10, 3, 330);
  ModelSettings settings = drifting("0.3");
  settings.window = 100;
  Estimator estimator(settings, bar_mesh());
  for (const Frame& frame : frames) {
    const StepResult result = estimator.step(frame);
    ASSERT_TRUE(result.used) << result.reason;
    if (frame.time > when + 1.0) {
      EXPECT_NEAR(value(estimator) / (2.0 * kTruth), 1.0, 0.02) << frame.time - when;
    }
  }
}

}  // namespace
}  // namespace tissue_stiffness
