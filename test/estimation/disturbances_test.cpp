// Recordings go wrong: outliers, bad frames, loads out of order. The result must not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "bar.hpp"
#include "settings/key_spec.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<std::string> kBar = bar_under_gravity(prior(50e3, 3));

std::vector<Frame> recording(int count = 20, unsigned seed = 1) {
  const Experiment bar(box_settings(kBar), bar_mesh(), {kTruth});
  return see_all(bar, bar.film(0.0, kFilmed, count), kNoise, seed);
}

std::string result_of(const std::vector<Frame>& frames) {
  Estimator estimator(box_settings(kBar), bar_mesh());
  step_through(estimator, frames);
  return bytes(estimator);
}

TEST(Outliers, DoNotMoveTheModulusByMoreThanItsInterval) {
  std::vector<Frame> frames = recording(30);
  Estimator clean(box_settings(kBar), bar_mesh());
  step_through(clean, frames);
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int thrown = 0;
  for (Frame& frame : frames) {
    Eigen::Matrix3Xd& points = frame.observations.front().points;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (unit(engine) > 0.1) continue;
      points.col(i) += 20.0 * kNoise * draw(1, 1.0, engine).col(0).normalized();
      ++thrown;
    }
  }
  Estimator disturbed(box_settings(kBar), bar_mesh());
  int found = 0;
  for (const Frame& frame : frames) found += disturbed.step(frame).misfit.outliers;
  const ParameterEstimate& a = clean.estimate().parameters.front();
  const ParameterEstimate& b = disturbed.estimate().parameters.front();
  std::printf("outliers: %d points, %d coordinates down-weighted; E %.1f +- %.1f Pa without, %.1f +- %.1f with\n", thrown,
              found, a.mean, a.std, b.mean, b.std);
  EXPECT_GT(thrown, 50);
  EXPECT_GT(found, thrown);
  EXPECT_LT(std::abs(a.mean - b.mean), a.upper95 - a.mean);
  EXPECT_TRUE(holds(b, kTruth));
  EXPECT_LT(b.std, 2.5 * a.std) << disturbed.estimate().state_reason;
}

TEST(BadFrames, AreSkippedWithAReasonAndChangeNothing) {
  const std::vector<Frame> frames = recording();
  struct Bad {
    std::string what, reason;
    Frame frame;
  };
  const auto changed = [&](const auto& change) {
    Frame frame = frames[10];
    frame.time = frame.observations[0].time = frames[9].time + 0.5 * kFilmed;
    change(frame);
    return frame;
  };
  const std::vector<Bad> all{
      {"late", "late", changed([&](Frame& f) { f.time = frames[4].time + 0.001; })},
      {"repeated", "late", frames[9]},
      {"no time", "time", changed([](Frame& f) { f.time = kNan; })},
      {"empty", "nothing", changed([](Frame& f) { f.observations.clear(); })},
      {"no points", "nothing", changed([](Frame& f) {
         f.observations[0].points.resize(3, 0);
         f.observations[0].ids.resize(0);
       })},
      {"not a number", "nothing", changed([](Frame& f) { f.observations[0].points.setConstant(kNan); })},
      {"infinite", "nothing", changed([](Frame& f) { f.observations[0].points.setConstant(INFINITY); })},
      {"no such vertex", "vertex 1000", changed([](Frame& f) { f.observations[0].ids[0] = 1000; })},
      {"no such sensor", "", changed([](Frame& f) { f.observations[0].source = 3; })}};
  const std::string undisturbed = result_of(frames);
  for (const Bad& bad : all) {
    Estimator estimator(box_settings(kBar), bar_mesh());
    step_through(estimator, {frames.begin(), frames.begin() + 10});
    const std::string before = bytes(estimator);
    const StepResult step = estimator.step(bad.frame);
    EXPECT_FALSE(step.used) << bad.what;
    EXPECT_FALSE(step.reason.empty()) << bad.what;
    EXPECT_NE(step.reason.find(bad.reason), std::string::npos) << bad.what << ": " << step.reason;
    EXPECT_TRUE(bytes(estimator) == before) << bad.what;
    EXPECT_EQ(step.estimate.parameters.front().mean, value(estimator)) << bad.what;
    step_through(estimator, {frames.begin() + 10, frames.end()});
    EXPECT_TRUE(bytes(estimator) == undisturbed) << bad.what;
  }
}

TEST(BadFrames, PointsWithoutANumberAreLeftOut) {
  std::vector<Frame> frames = recording();
  const std::string before = result_of(frames);
  std::vector<Frame> holes = frames;
  for (Frame& frame : holes) {
    frame.observations[0].points.col(7).setConstant(kNan);
    frame.observations[0].points(1, 11) = INFINITY;
  }
  Estimator estimator(box_settings(kBar), bar_mesh());
  const StepResult last = step_through(estimator, holes);
  EXPECT_TRUE(last.used);
  EXPECT_EQ(last.misfit.count, 3 * bar_mesh().corner_count - 4);
  EXPECT_TRUE(holds(last.estimate.parameters.front(), kTruth));
}

TEST(BadFrames, FramesBeforeTheStartAreSkipped) {
  const ModelSettings settings = box_settings(kBar, "[{vertices: {topic: /v, noise: 1.0e-4}}]", "time: {start: 0.1}");
  const Experiment bar(settings, bar_mesh(), {kTruth});
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 30), kNoise, 3);
  Estimator estimator(settings, bar_mesh());
  int skipped = 0;
  for (const Frame& frame : frames) skipped += estimator.step(frame).used ? 0 : 1;
  EXPECT_EQ(skipped, 5);  // 0 to 0.08 s
  EXPECT_TRUE(holds(estimator.estimate().parameters.front(), kTruth));
}

TEST(Reset, EqualsAFreshEstimatorBitForBit) {
  const std::vector<Frame> frames = recording(), others = recording(25, 2);
  for (const std::string& kind : find_key(model_keys(), "estimator").choices) {
    const ModelSettings settings = box_settings(kBar, "[{vertices: {topic: /v, noise: 1.0e-4}}]", "estimator: " + kind);
    Estimator fresh(settings, bar_mesh()), used(settings, bar_mesh());
    step_through(used, others);
    used.reset();
    EXPECT_TRUE(bytes(used) == bytes(fresh)) << kind;
    step_through(used, frames);
    step_through(fresh, frames);
    EXPECT_TRUE(bytes(used) == bytes(fresh)) << kind;
  }
}

TEST(Estimators, AnUnknownNameIsRefused) {
  ModelSettings settings = box_settings(kBar);
  settings.estimator = "kalman";
  EXPECT_THROW(Estimator(settings, bar_mesh()), InputError);
}

TEST(Reset, ForgetsAnInitialVelocityReadFromFrames) {
  const ModelSettings settings =
      box_settings(kBar, "[{vertices: {topic: /v, noise: 1.0e-4}}]", "initial: {velocity: from_frames}");
  Estimator fresh(settings, bar_mesh()), used(settings, bar_mesh());
  step_through(used, recording(25, 2));
  used.reset();
  EXPECT_TRUE(bytes(used) == bytes(fresh));
  const std::vector<Frame> frames = recording();
  step_through(used, frames);
  step_through(fresh, frames);
  EXPECT_TRUE(bytes(used) == bytes(fresh));
}

TEST(Determinism, SameInputSameBytes) {
  const std::vector<Frame> frames = recording();
  const std::string first = result_of(frames);
  EXPECT_TRUE(result_of(frames) == first);
  EXPECT_FALSE(result_of(recording(20, 2)) == first);
}

TEST(Determinism, OfTheFullModelToo) {
  const ModelSettings settings =
      box_settings({"inertia: {density: 1000}",
                    "elasticity: {law: neo_hookean, poisson_ratio: 0.4, young_modulus: {prior: 3.0e4, factor: 2}}",
                    "fixed: {region: clamp}", "gravity: {acceleration: [0, 0, -9.81]}"},
                   "[{vertices: {topic: /v, noise: 1.0e-4}}]", "time: {step: 0.005}");
  const TetMesh mesh = bar_mesh(2);
  const Experiment bar(settings, mesh, {25e3});
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 6), kNoise, 4);
  Estimator first(settings, mesh), second(settings, mesh);
  step_through(first, frames);
  step_through(second, frames);
  EXPECT_TRUE(bytes(first) == bytes(second));
  EXPECT_NEAR(value(first) / 25e3, 1.0, 0.05);
}

}  // namespace
}  // namespace tissue_stiffness
