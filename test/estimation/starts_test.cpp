// Estimates reach the truth from far starts: one modulus, several, damping, a velocity read from the frames, the paper's
// own scheme.
#include <gtest/gtest.h>

#include <algorithm>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

TEST(Starts, TenTimesOffReachesFivePercentWithinThirtyFrames) {
  const TetMesh mesh = bar_mesh();
  for (const double truth : {5e3, 60e3}) {
    const Experiment bar(box_settings(bar_under_gravity(prior(truth, 3))), mesh, {truth});
    const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 30), kNoise, 1);
    for (const double off : {0.1, 10.0}) {
      Estimator estimator(box_settings(bar_under_gravity(prior(off * truth, 3))), mesh);
      int within = 0;  // frames since the estimate came within 5 % to stay
      for (const Frame& frame : frames) {
        EXPECT_TRUE(estimator.step(frame).used);
        within = std::abs(value(estimator) / truth - 1.0) < 0.05 ? within + 1 : 0;
      }
      std::printf("E = %g Pa, start %gx: within 5 %% from frame %d on, %+.3f %% off at the end\n", truth, off,
                  static_cast<int>(frames.size()) - within + 1, 100.0 * (value(estimator) / truth - 1.0));
      EXPECT_GT(within, 0);
      EXPECT_TRUE(holds(estimator.estimate().parameters.front(), truth));
      EXPECT_EQ(estimator.estimate().state, EstimateState::converged);
    }
  }
}

// A replay that begins where another fit ended comes to that fit's estimate. One that begins a few standard deviations off
// does, too.
TEST(Starts, AReplayNearAnEstimateEndsWhereAPlainOneDoes) {
  const TetMesh mesh = bar_mesh();
  const auto model = box_settings(bar_under_gravity(prior(50e3, 3)));
  const Experiment bar(model, mesh, {20e3});
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 40), kNoise, 3);
  Estimator plain(model, mesh);
  plain.replay(frames);
  const ParameterEstimate expected = plain.estimate().parameters.front();
  for (const double off : {1.0, 1.002}) {
    Estimate guess = plain.estimate();
    guess.parameters.front().mean *= off;
    Estimator near(model, mesh);
    const StepResult last = near.replay(frames, &guess);
    EXPECT_TRUE(last.used);
    EXPECT_NEAR(value(near) / expected.mean, 1.0, 2e-4) << off;
    EXPECT_NEAR(near.estimate().parameters.front().std / expected.std, 1.0, 0.1) << off;
  }
}

TEST(Starts, TwoRegionsGetTheirOwnModulus) {
  const TetMesh mesh = bar_mesh();
  const auto model = [](double near, double far) {
    return box_settings({"inertia: {density: 1000}", modulus(prior(near, 3), "near"), modulus(prior(far, 3), "far"),
                         "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -3]}"});
  };
  const std::vector<double> truth{20e3, 45e3};
  const Experiment bar(model(truth[0], truth[1]), mesh, truth);
  Estimator estimator(model(50e3, 15e3), mesh);
  // The basis follows the start's ratio of moduli, so the noise is well above what it leaves out.
  const StepResult last = step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 40), kNoise, 2));
  for (std::size_t i = 0; i < 2; ++i) {
    const ParameterEstimate& p = last.estimate.parameters[i];
    std::printf("%s: %.0f Pa, truth %.0f, 95 %% %.0f..%.0f\n", p.name.c_str(), p.mean, truth[i], p.lower95, p.upper95);
    EXPECT_NEAR(p.mean / truth[i], 1.0, 0.02);
  }
  EXPECT_NE(last.estimate.parameters[0].name, last.estimate.parameters[1].name);
  EXPECT_EQ(last.estimate.covariance.rows(), 2);
  // A stiffer half compensates for a softer one.
  EXPECT_LT(last.estimate.covariance(0, 1), 0.0);
}

TEST(Starts, ModulusAndViscousDampingTogether) {
  const TetMesh mesh = bar_mesh();
  const auto model = [](double young, double beta) {
    std::vector<std::string> effects = bar_under_gravity(prior(young, 3));
    effects.push_back("viscous_damping: {beta: " + prior(beta, 5) + "}");
    return box_settings(effects);
  };
  const std::vector<double> truth{30e3, 4e-3};
  const Experiment bar(model(truth[0], truth[1]), mesh, truth);
  Estimator estimator(model(12e3, 5e-4), mesh);
  const StepResult last = step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 40), kNoise, 3));
  for (std::size_t i = 0; i < 2; ++i) {
    const ParameterEstimate& p = last.estimate.parameters[i];
    std::printf("%s: %.5g, truth %.5g, 95 %% %.5g..%.5g\n", p.name.c_str(), p.mean, truth[i], p.lower95, p.upper95);
    EXPECT_TRUE(holds(p, truth[i])) << p.name;
    EXPECT_NEAR(p.mean / truth[i], 1.0, 0.05);
  }
}

TEST(Starts, TheInitialVelocityIsReadFromTheFrames) {
  const TetMesh mesh = bar_mesh(2);
  const auto model = [](const std::string& velocity) {
    return box_settings({"inertia: {density: 1000}", modulus(prior(30e3, 3)), "fixed: {region: clamp}"},
                        "[{vertices: {topic: /vertices, noise: 1.0e-4}}]", "initial: {velocity: " + velocity + "}");
  };
  const Experiment bar(model("[0, 0, -0.3]"), mesh, {40e3});
  Estimator estimator(model("from_frames"), mesh);
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, 0.004, 40), kNoise, 4);
  EXPECT_FALSE(estimator.step(frames[0]).used);
  EXPECT_NE(estimator.step(frames[1]).reason.find("velocity"), std::string::npos);
  step_through(estimator, {frames.begin() + 2, frames.end()});
  EXPECT_NEAR(value(estimator) / 40e3, 1.0, 0.05);
}

// The loading is quasi-static between frames, so the paper's differences (eq. 24, 25) are good to second order.
TEST(Starts, ThePapersSchemeConvergesUnderASlowLoad) {
  const TetMesh mesh = bar_mesh(3);
  const auto model = [](double young) {
    return box_settings({"inertia: {density: 1000}", modulus(prior(young, 2)), "fixed: {region: clamp}",
                         "mass_damping: {alpha: 40}", "traction: {region: tip, topic: /wrench}"},
                        "[{vertices: {topic: /vertices, noise: 2.0e-5}}]", "estimator: paper");
  };
  Experiment bar(model(20e3), mesh, {20e3});
  Estimator estimator(model(40e3), mesh);
  for (int k = 0; k <= 200; ++k) {
    LoadSample sample{"/wrench", 0.05 * k, Eigen::VectorXd::Zero(6)};
    sample.value[2] = 5e-3 * (1.0 - std::cos(0.8 * sample.time));
    bar.add_load(sample);
    estimator.add_load(sample);
  }
  EXPECT_NE(estimator.description().front().find("paper"), std::string::npos);
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, 0.1, 60), 2e-5, 5);
  EXPECT_FALSE(estimator.step(frames[0]).used);
  EXPECT_FALSE(estimator.step(frames[1]).used);
  std::vector<double> errors;
  for (std::size_t k = 2; k < frames.size(); ++k) {
    const StepResult step = estimator.step(frames[k]);
    EXPECT_TRUE(step.used) << step.reason;
    errors.push_back(std::abs(std::log(value(estimator) / 20e3)));
  }
  std::printf("paper's scheme: start 2x, %+.2f %% off after %zu frames\n", 100.0 * (value(estimator) / 20e3 - 1.0),
              errors.size());
  EXPECT_LT(errors.back(), 0.05);
}

}  // namespace
}  // namespace tissue_stiffness
