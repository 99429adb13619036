// A diagnosis takes the errors of time steps and of a coarse mesh for numerics, and names effects beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/finding.hpp"
#include "diagnosis/fit_given_model.hpp"
#include "diagnosis/screening.hpp"
#include "filmed_bar.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

// Simulates with Newmark's average acceleration, in steps of length `step` alone.
Recording simulate(const std::vector<std::string>& hidden, double step, unsigned seed) {
  std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
  effects.insert(effects.end(), hidden.begin(), hidden.end());
  const Experiment truth(box_settings(effects), bar_mesh(), {kTruth});
  FullModel::Options options;
  options.step = step;
  options.spectral_radius = 1.0;
  const auto run = FullModel(truth.model(), options)
                       .start(truth.model().parameters().theta(truth.model().parameters().prior_mean()), 0.0);
  std::vector<Experiment::Moment> moments;
  for (int k = 0; k < 60; ++k) {
    run->advance(0.02 * k);
    moments.push_back({0.02 * k, run->displacement()});
  }
  Recording recording;
  recording.frames = see_all(truth, moments, kNoise, seed);
  return recording;
}

// A step a frame: swings of the second mode take a tenth longer.
TEST(Diagnose, TakesTheTimeStepsOfASimulationForNumerics) {
  constexpr double step = 0.01;  // half a frame
  const Recording recording = simulate({}, step, 8);
  const Diagnosis d = diagnose_bar(recording, {});
  EXPECT_EQ(d.verdict, Verdict::numerics);
  EXPECT_TRUE(d.set.empty());
  DiagnosisOptions options;
  options.add = {"period_elongation"};
  const auto known = diagnose_bar(recording, options).steps.back().parameters;
  EXPECT_NEAR(std::sqrt(known.at("period_elongation.step_squared")), step, 0.1 * step);
  EXPECT_NEAR(known.at("elasticity.young_modulus") / kTruth, 1.0, 0.003);
}

// Late fast swings resemble the other damping, so both explain the same share.
TEST(Diagnose, TellsEquivalentEffectsApartBesideTheTimeStepsOfASimulation) {
  for (const std::string alpha : {"3", "4"}) {
    const Diagnosis d = diagnose_bar(simulate({"mass_damping: {alpha: " + alpha + "}"}, 0.01, 9), {});
    const auto explained = [&](const std::string& effect) {
      const auto found = std::find_if(d.candidates.begin(), d.candidates.end(),
                                      [&](const MissingEffect& c) { return c.effect == effect; });
      return found == d.candidates.end() ? 0.0 : found->explained;
    };
    std::printf("mass damping of %s/s in steps of half a frame: it explains %.2f %%, viscous damping %.2f %%\n",
                alpha.c_str(), 100.0 * explained("mass_damping"), 100.0 * explained("viscous_damping"));
    EXPECT_NEAR(explained("viscous_damping"), explained("mass_damping"), 2e-3) << "no test: one explains more anyway";
    EXPECT_EQ(d.verdict, Verdict::missing);
    ASSERT_FALSE(d.set.empty());
    EXPECT_EQ(d.set.front(), "mass_damping") << alpha;
  }
}

// Films on a mesh three times as fine, seen at the coarse one's vertices.
Recording film_finer(const ModelSettings& settings, const TetMesh& coarse, double noise = 0.1 * kNoise) {
  const Experiment experiment(settings, bar_mesh(24, 6, 6), {kTruth});
  std::mt19937 engine(1);
  Recording recording;
  recording.frames = see_on(coarse, corners(coarse), experiment, experiment.film(0.0, 0.02, 60), noise, engine);
  return recording;
}

TEST(Diagnose, TakesTheErrorOfACoarseMeshForNoEffect) {
  ModelSettings settings = box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}"));
  const TetMesh coarse = bar_mesh(8, 2, 2);
  const Recording recording = film_finer(settings, coarse);
  settings.mesh.discretisation_error = true;
  const Diagnosis d = diagnose(settings, coarse, recording, {});
  EXPECT_EQ(d.verdict, Verdict::numerics) << "noise of 0.01 mm under an error of the mesh of " << d.metres.numerical
                                          << " m";
  EXPECT_TRUE(d.set.empty());
  EXPECT_GT(d.sigmas.numerical, 1.0);
}

// The change does not depend on the recording, nor on whether the finer mesh is known.
TEST(Diagnose, FindsOutWhatAFinerMeshChanges) {
  ModelSettings settings = box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}"));
  const TetMesh coarse = bar_mesh(8, 2, 2);
  const Recording recording = film_finer(settings, coarse);
  settings.mesh.discretisation_error = true;
  FittedModel base;
  base.recording_fit = std::make_unique<RecordingFit>(settings, coarse, recording);
  const Model& model = base.recording_fit->model();
  base.fit = base.recording_fit->fit(model.parameters().prior_mean(), 0.1 * model.parameters().prior_std());
  base.rows = base.recording_fit->rows(base.fit.w);
  const FinerMesh alone = finer_mesh(base);
  EXPECT_GT(alone.change.dot(base.rows.error), 0.9 * alone.change.norm() * base.rows.error.norm());
  EXPECT_TRUE(alone.change.isApprox(finer_mesh(base, alone.recording_fit.get()).change, 1e-6));
  base.rows.error *= -3.0;
  EXPECT_TRUE(alone.change.isApprox(finer_mesh(base, alone.recording_fit.get()).change, 1e-6));
}

// A bar that rings runs out of phase with itself on a finer mesh. One that is damped soon hangs still, and E makes up for
// most of what the mesh changes.
TEST(Diagnose, TestsTheMostProbableModelByTheErrorOfItsOwnMesh) {
  std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
  ModelSettings settings = box_settings(effects);
  effects.push_back("mass_damping: {alpha: 20}");
  const TetMesh coarse = bar_mesh(8, 2, 2);
  const Recording recording = film_finer(box_settings(effects), coarse, kNoise);
  settings.mesh.discretisation_error = true;
  FittedModel base = fit_given_model(settings, coarse, recording);
  const Finding finding = diagnose_once(base, {"mass_damping"}, {});
  ASSERT_FALSE(finding.refits.empty());
  const Refit& best = finding.refits.front();
  ASSERT_NE(best.model, nullptr);
  ASSERT_NE(best.explained->mesh, nullptr);
  const Eigen::VectorXd change = finer_mesh(*best.model).change;
  ModelComparison of_own = *finding.models;
  of_own.allow_for_mesh(change);
  EXPECT_GT(finding.models->mesh_directions().norm(), 1.5 * of_own.mesh_directions().norm());
  Explained alike = *best.explained;
  alike.mesh = nullptr;
  const Assessment by_own = of_own.assess(alike), by_base = finding.models->assess(alike);
  EXPECT_NEAR(best.assessment.test.z, by_own.test.z, 0.01);
  EXPECT_GT(std::abs(by_own.test.z - by_base.test.z), 1.0);
  EXPECT_EQ(best.assessment.log_evidence, by_base.log_evidence) << "evidences are compared, so they share one allowance";
}

// Returns the diagnosis of a bar with springs on a coarse mesh, filmed on a finer one.
Diagnosis diagnose_springs_on_coarse_mesh(const std::string& stiffness) {
  std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
  ModelSettings settings = box_settings(effects);
  effects.push_back("foundation: {region: top, stiffness: " + stiffness + "}");
  const TetMesh coarse = bar_mesh(8, 2, 2);
  const double noise = 5.0 * kNoise;
  const Recording recording = film_finer(box_settings(effects), coarse, noise);
  settings.mesh.discretisation_error = true;
  settings.observations.front().noise = noise;
  return diagnose(settings, coarse, recording, {});
}

// Fibres imitate the mesh's error as well. The test of all squares passes with these springs.
TEST(Diagnose, NamesAnEffectBesideTheErrorOfTheMesh) {
  const Diagnosis d = diagnose_springs_on_coarse_mesh("150");
  EXPECT_LT(d.z, MisfitTest::beyond_chance);
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "foundation");
}

// Fibres explain these springs, too, and E is then a third too low. The springs explain more, but only in another variant
// than the one that the tangents prefer.
TEST(Diagnose, ComparesEffectsByTheirBestVariants) {
  const Diagnosis d = diagnose_springs_on_coarse_mesh("350");
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "foundation");
}

// Weak springs are less than what another mesh would change. So nothing is named, and E's interval tells of them.
TEST(Diagnose, NamesNothingThatTheLargestErrorOfTheMeshMayBe) {
  const Diagnosis d = diagnose_springs_on_coarse_mesh("100");
  EXPECT_EQ(d.verdict, Verdict::numerics);
  EXPECT_LT(d.z, MisfitTest::bound);
  const ParameterEstimate& modulus = d.estimate.parameters.front();
  EXPECT_LT(modulus.lower95, kTruth);
  EXPECT_GT(modulus.upper95, kTruth);
  const auto springs = [](const RivalExplanation& trace) { return trace.effect == "foundation"; };
  EXPECT_TRUE(std::any_of(d.traces.begin(), d.traces.end(), springs));
}

}  // namespace
}  // namespace tissue_stiffness
