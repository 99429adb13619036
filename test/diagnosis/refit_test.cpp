// Fits of a model with one effect more.
#include "diagnosis/refit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../estimation/bar.hpp"
#include "diagnosis/initial_segment.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 36;
constexpr double kTruth = 30e3, kDamping = 4.0;

class RefitTest : public ::testing::Test {
 protected:
  RefitTest() {
    std::vector<std::string> effects = bar_under_gravity(prior(kTruth, 2.0));
    const ModelSettings given = box_settings(effects);
    effects.push_back("mass_damping: {alpha: 4}");
    const Experiment truth(box_settings(effects), bar_mesh(), {kTruth});
    recording.frames = see_all(truth, truth.film(0.0, kFilmed, kFrames), kNoise, 5);
    auto recording_fit = std::make_unique<RecordingFit>(given, bar_mesh(), recording);
    const Eigen::VectorXd w = recording_fit->scan(recording_fit->model().parameters().prior_mean());
    base = fit_recording(std::move(recording_fit), w, 0.1);
    for (Candidate& candidate : propose_candidates(*base.recording_fit, base.fit.w, {})) {
      if (candidate.effect == "mass_damping") damping = candidate;
      if (candidate.effect == "geometric_nonlinearity") finite_strain = candidate;
    }
  }
  Recording recording;
  FittedModel base;
  Candidate damping, finite_strain;
};

TEST_F(RefitTest, FitsTheInitialSegmentFromAKnownPlace) {
  ASSERT_EQ(damping.effect, "mass_damping");
  const RankedFit fit = fit_initial_segment(
      base, damping, {{{"elasticity.young_modulus", 0.97 * kTruth}, {"mass_damping.alpha", 0.5 * kDamping}}});
  const double rows = kInitialSegment * base.rows.count() * static_cast<double>(recording.training().size()) / kFrames;
  EXPECT_NEAR((fit.deviance - std::log(kInitialSegment * base.rows.count())) / rows, 1.0, 0.15);
  EXPECT_NEAR(fit.parameters.at("elasticity.young_modulus"), kTruth, 0.02 * kTruth);
  EXPECT_NEAR(fit.parameters.at("mass_damping.alpha"), kDamping, 0.2 * kDamping);
}

TEST_F(RefitTest, ScansTheInitialSegmentAcrossThePriors) {
  const std::vector<RankedFit> places = scan_initial_segment(base, damping);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_LE(places[0].deviance, places[1].deviance);
  EXPECT_NEAR(places[0].parameters.at("elasticity.young_modulus"), kTruth, 0.2 * kTruth);
  EXPECT_GT(places[0].parameters.at("mass_damping.alpha"), 0.25 * kDamping);
  EXPECT_LT(places[0].deviance, base.fit.cost);
}

TEST_F(RefitTest, FindsTheTruthFromThere) {
  RefitTask task{&damping, {}, {{"elasticity.young_modulus", 0.97 * kTruth}, {"mass_damping.alpha", 0.7 * kDamping}}};
  const Refit refit = refit_with(base, task, {});
  EXPECT_NEAR(refit.parameters.at("elasticity.young_modulus"), kTruth, 0.01 * kTruth);
  EXPECT_NEAR(refit.parameters.at("mass_damping.alpha"), kDamping, 0.05 * kDamping);
  EXPECT_LT(refit.cost, 1.1 * base.rows.count());
}

// The time steps of a simulated recording are fitted with a model, unless another one is far ahead of it.
TEST_F(RefitTest, FitsTimeStepsWithWhatMayWin) {
  std::vector<std::string> effects = bar_under_gravity(prior(kTruth, 2.0));
  effects.emplace_back("mass_damping: {alpha: 4}");
  effects.emplace_back("period_elongation: {step_squared: 1.0e-4}");
  const Experiment truth(box_settings(effects), bar_mesh(), {kTruth});
  recording.frames = see_all(truth, truth.film(0.0, kFilmed, kFrames), kNoise, 5);
  auto recording_fit =
      std::make_unique<RecordingFit>(box_settings(bar_under_gravity(prior(kTruth, 2.0))), bar_mesh(), recording);
  const Eigen::VectorXd w = recording_fit->scan(recording_fit->model().parameters().prior_mean());
  base = fit_recording(std::move(recording_fit), w, 0.1);
  const RefitTask task{&damping, {}, {{"elasticity.young_modulus", kTruth}, {"mass_damping.alpha", kDamping}}};
  const Refit alone = refit_with(base, task, {});
  RefitLimits limits;
  limits.rival = 0.5 * alone.fitted;
  const Refit behind = refit_with(base, task, limits);
  EXPECT_LT(alone.explained->error.squaredNorm(), 1.1 * base.rows.count());
  EXPECT_GT(alone.model->rows.error.squaredNorm(), 1.2 * base.rows.count());
  EXPECT_EQ(behind.explained->error, behind.model->rows.error);
}

// What the time steps do to the base is known before its refits. A refit that is fitted with them contains the base.
TEST_F(RefitTest, FitsTimeStepsNoWorseThanTheBaseDoes) {
  std::vector<std::string> effects = bar_under_gravity(prior(kTruth, 2.0));
  effects.emplace_back("period_elongation: {step_squared: 4.0e-4}");
  const Experiment truth(box_settings(effects), bar_mesh(), {kTruth});
  recording.frames = see_all(truth, truth.film(0.0, kFilmed, kFrames), kNoise, 5);
  base = fit_recording(
      std::make_unique<RecordingFit>(box_settings(bar_under_gravity(prior(kTruth, 2.0))), bar_mesh(), recording),
      base.fit.w, 0.1);
  const Explained steps = compared_residual(base, {}, FittedNumerics::far);
  ASSERT_FALSE(steps.steps.place.empty());
  RefitLimits limits;
  limits.steps = steps.steps;
  const Refit refit = refit_with(base, {&damping, Eigen::VectorXd::Constant(1, 0.1)}, limits);
  EXPECT_LT(refit.explained->error.squaredNorm(), 1.01 * steps.error.squaredNorm());
}

TEST_F(RefitTest, RunsANonlinearModelInFullWhereItsFirstOrderExplainsEnough) {
  ASSERT_EQ(finite_strain.effect, "geometric_nonlinearity");
  const RefitTask task{&finite_strain, Eigen::VectorXd::Constant(1, 1.0)};
  RefitLimits limits;
  limits.least_gain = base.rows.error.squaredNorm();
  EXPECT_EQ(refit_with(base, task, limits).model, nullptr);
  limits.least_gain = -no_rival;
  EXPECT_NE(refit_with(base, task, limits).model, nullptr);
}

}  // namespace
}  // namespace tissue_stiffness
