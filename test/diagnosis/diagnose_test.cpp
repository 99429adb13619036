// In recordings of a bar with something hidden the diagnosis names it, proves it, and is silent where nothing is.
#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/finding.hpp"
#include "filmed_bar.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

TEST(Diagnose, FindsNothingWhereNothingIsMissing) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Diagnosis d = diagnose_bar(film({}, seed), {});
    EXPECT_EQ(d.verdict, Verdict::adequate) << seed;
    EXPECT_TRUE(d.set.empty());
    EXPECT_NEAR(d.steps.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.01);
  }
}

// A load that the recorder missed for a while is held by the model. What the body does meanwhile is no effect.
TEST(Diagnose, LeavesOutFramesDuringWhichALoadWasSilent) {
  std::vector<std::string> effects = bar_under_gravity("{prior: 35.0e3, factor: 3}");
  effects.back() = "traction: {region: tip, topic: /wrench}";
  Experiment experiment(box_settings(effects), bar_mesh(), {kTruth});
  Recording recording;
  for (int k = 0; k < 260; ++k) {
    const double t = 0.005 * k;
    LoadSample sample{"/wrench", t, Eigen::VectorXd::Zero(6)};
    const double phase = 9.0 * (std::min(t, 0.5) + std::max(t - 0.85, 0.0));  // at rest while nobody tells of it
    sample.value[2] = -6e-3 * (1.0 - std::cos(phase));
    experiment.add_load(sample);
    if (t < 0.52 || t > 0.83) recording.loads.push_back(sample);
  }
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), kNoise, 1);
  recording.frames.back().observations.push_back(recording.frames.back().observations.front());
  const Diagnosis d = diagnose(box_settings(effects), bar_mesh(), recording, {});
  EXPECT_EQ(d.left_out, "14 of 60 frames (no load on /wrench for 0.305 s, where one comes every 0.005 s)");
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_NEAR(d.steps.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.02);
}

// A larger model that finds another minimum shows the given one where to start: nothing is missing there. All effects have
// to be compared from there, too.
TEST(Diagnose, StartsTheGivenModelWhereARefitEnds) {
  const Recording recording = film({}, 1);
  FittedModel base;
  base.recording_fit =
      std::make_unique<RecordingFit>(box_settings(bar_under_gravity("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording);
  base.fit = base.recording_fit->fit(base.recording_fit->model().parameters().prior_mean(),
                                     0.1 * base.recording_fit->model().parameters().prior_std());
  base.rows = base.recording_fit->rows(base.fit.w);
  EXPECT_FALSE(diagnose_once(base, {}, {}).base_moved);
  base.fit.w[0] = std::log(1.25 * kTruth);
  base.rows = base.recording_fit->rows(base.fit.w);
  base.fit.cost = base.rows.error.squaredNorm();
  const Finding finding = diagnose_once(base, {}, {});
  EXPECT_TRUE(finding.base_moved);
  EXPECT_NEAR(std::exp(base.fit.w[0]) / kTruth, 1.0, 0.01);
  EXPECT_EQ(finding.verdict, Verdict::adequate);
  EXPECT_TRUE(finding.to_repeat);
}

// A finding is judged anew when another round has shown the noise or the mesh's error to be different.
TEST(Diagnose, JudgesAFindingByAnotherLikelihood) {
  const Recording recording = film({"viscous_damping: {beta: 6.0e-3}"}, 1);
  FittedModel base = fit_recording(
      std::make_unique<RecordingFit>(box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}")), bar_mesh(), recording),
      Eigen::VectorXd::Constant(1, std::log(kTruth)), 0.1);
  Finding finding = diagnose_once(base, {}, {});
  ASSERT_EQ(finding.verdict, Verdict::missing);
  ASSERT_EQ(finding.refits.front().effect, "viscous_damping");
  std::rotate(finding.refits.begin(), finding.refits.begin() + 1, finding.refits.end());
  finding.judge_by(finding.models);
  EXPECT_EQ(finding.verdict, Verdict::missing);
  EXPECT_EQ(finding.refits.front().effect, "viscous_damping");
  EXPECT_FALSE(finding.set.empty());
  finding.judge_by(std::make_shared<const ModelComparison>(base, 10.0 * motion_of(base.rows)));
  EXPECT_EQ(finding.verdict, Verdict::numerics);
  EXPECT_TRUE(finding.set.empty());
}

// On a finer mesh a nonlinear model runs what is linear in it, because the shapes that the elements lack are the same.
TEST(Diagnose, TestsANonlinearModelWithTheErrorOfItsOwnMesh) {
  Recording recording = film({}, 1);
  recording.frames.resize(20);
  ModelSettings settings = box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}"));
  settings.mesh.discretisation_error = true;
  FittedModel base = fit_recording(std::make_unique<RecordingFit>(settings, bar_mesh(), recording),
                                   Eigen::VectorXd::Constant(1, std::log(kTruth)), 0.1);
  const Finding finding = diagnose_once(base, {"geometric_nonlinearity"}, {});
  ASSERT_EQ(finding.refits.size(), 1U);
  const Refit& refit = finding.refits.front();
  ASSERT_NE(refit.model, nullptr);
  ASSERT_NE(refit.explained->mesh, nullptr);
  const FinerMesh finer = finer_mesh(*refit.model);
  ASSERT_NE(finer.recording_fit, nullptr);
  EXPECT_TRUE(finer.recording_fit->linear());
  const Eigen::VectorXd own = refit.explained->mesh->columns.rowwise().sum();
  EXPECT_LT((own - kComparison.whole_mesh * finer.change).norm(), 1e-6 * own.norm());
  base.fit.w = refit.model->fit.w;
  base.rows = base.recording_fit->rows(base.fit.w);
  const Eigen::VectorXd linear = finer_mesh(base).change;
  EXPECT_LT((finer.change - linear).norm(), 0.1 * linear.norm());
}

TEST(Diagnose, DoesNotLookForWhatItIsToldToIgnore) {
  DiagnosisOptions options;
  options.ignore = {"viscous_damping", "mass_damping", "viscoelasticity"};
  for (const char* slow : {"added_mass", "elastic_support", "fibre_reinforcement", "geometric_nonlinearity",
                           "stiff_inclusion", "strain_stiffening"})
    options.ignore.emplace_back(slow);
  options.automatic = true;
  const Diagnosis d = diagnose_bar(film({"viscous_damping: {beta: 6.0e-3}"}, 1), options);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_EQ(d.steps.size(), 1U) << "nothing is added that does not explain the error";
  EXPECT_EQ(d.final_verdict, Verdict::unexplained);
  for (const MissingEffect& effect : d.candidates) EXPECT_NE(effect.effect, "viscous_damping");
  options.ignore = {"magic"};
  EXPECT_NE(refusal([&] { diagnose_bar(film({}, 1), options); }).find("magic"), std::string::npos);
}

// The effect is so strong that E compensates for it with three times its value, and phases drift apart where tangents are
// read.
TEST(Diagnose, FindsAStrongEffectFromTheRecordingsBeginning) {
  const Recording recording = film({"foundation: {stiffness: 1000}"}, 6);
  const Diagnosis d = diagnose_bar(recording, {});
  EXPECT_GT(d.steps.front().parameters.at("elasticity.young_modulus"), 3.0 * kTruth);
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.candidates.empty());
  EXPECT_EQ(d.candidates.front().effect, "foundation");
  EXPECT_NEAR(d.candidates.front().parameters.at("foundation.stiffness"), 1e3, 20.0);
  EXPECT_NEAR(d.candidates.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.01);
  EXPECT_LT(d.candidates.front().held_out_rms_after, 1.1 * kNoise);
}

// The springs are a thousandth of those that a stout body would notice.
TEST(Diagnose, SeesWeakSurroundingsOfASlenderBar) {
  const Diagnosis d = diagnose_bar(film({"foundation: {region: top, stiffness: 20}"}, 7), {});
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "foundation");
  EXPECT_NEAR(d.candidates.front().parameters.at("foundation.stiffness"), 20.0, 1.0);
}

// No region has it, and no proposal's place is just there.
TEST(Diagnose, FindsWhereAMassIs) {
  const Diagnosis d = diagnose_bar(film({"added_mass: {center: [0.07, 0.003, 0.002], mass: 0.004}"}, 8), {});
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "added_mass");
  const auto& found = d.candidates.front().parameters;
  EXPECT_NEAR(found.at("added_mass.center_x"), 0.07, 0.005);
  EXPECT_NEAR(found.at("added_mass.mass"), 0.004, 4e-4);
  EXPECT_NEAR(found.at("elasticity.young_modulus") / kTruth, 1.0, 0.03);
}

// The effect is smaller than the noise: what the tangents do not declare may explain it as well.
TEST(Diagnose, RefitsTheRivalsOfAFaintEffect) {
  const Diagnosis d = diagnose_bar(film({"foundation: {region: top, stiffness: 24}"}, 7), {});
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "foundation");
  const auto mass = std::find_if(d.candidates.begin(), d.candidates.end(),
                                 [](const MissingEffect& c) { return c.effect == "added_mass"; });
  ASSERT_NE(mass, d.candidates.end());
  EXPECT_TRUE(std::isfinite(mass->held_out_rms_after));
}

// E compensates for most of the springs below the clamp; what it leaves is within what may be noise.
TEST(Diagnose, FindsWhatTheModulusCompensatesFor) {
  const std::string sensor = "[{vertices: {topic: /vertices, noise: 4.0e-3}}]";
  std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
  effects.push_back("elastic_support: {region: clamp, compliance: 2.0e-7}");
  const Experiment experiment(box_settings(effects, sensor), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), 4e-3, 10);
  const Diagnosis d =
      diagnose(box_settings(bar_under_gravity("{prior: 35.0e3, factor: 3}"), sensor), bar_mesh(), recording, {});
  std::printf("a compliant support: E %.1f kPa for 20 without it, %.3f sigma rms\n",
              1e-3 * d.steps.front().parameters.at("elasticity.young_modulus"), d.sigmas.total);
  EXPECT_LT(d.sigmas.total, 1.1);
  EXPECT_LT(d.steps.front().parameters.at("elasticity.young_modulus"), 0.9 * kTruth);
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "elastic_support");
  EXPECT_NEAR(d.candidates.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.03);
}

TEST(Diagnose, SplitsTheErrorByPlaceTimeFrequencyAndAmplitude) {
  const Diagnosis d = diagnose_bar(film({"viscous_damping: {beta: 6.0e-3}"}, 4), {});
  EXPECT_NEAR(d.metres.noise, kNoise, 1e-12);
  EXPECT_NEAR(std::pow(d.metres.structured, 2) + std::pow(kNoise, 2), std::pow(d.metres.total, 2), 1e-14);
  EXPECT_EQ(d.sigmas.numerical, 0.0);
  const ResidualViews& r = d.residual;
  ASSERT_EQ(r.time.size(), 60U);
  double mean_square = 0.0;
  for (const double rms : r.frame_rms) mean_square += rms * rms / 60.0;
  EXPECT_NEAR(std::sqrt(mean_square), d.sigmas.total, 1e-6);
  mean_square = 0.0;
  for (const double rms : r.node_rms) mean_square += rms * rms / static_cast<double>(r.node_rms.size());
  EXPECT_NEAR(std::sqrt(mean_square), d.sigmas.total, 1e-6);
  double power = 0.0;
  for (const double p : r.power) power += p;
  EXPECT_NEAR(power, 1.0, 1e-12);
  EXPECT_TRUE(std::is_sorted(r.amplitude.begin(), r.amplitude.end()));
  EXPECT_EQ(r.amplitude.size(), r.amplitude_rms.size());
  EXPECT_EQ(r.phase.size(), r.phase_rms.size());
}

TEST(Diagnose, EndsWhenItIsTold) {
  Recording recording = film({"viscous_damping: {beta: 6.0e-3}"}, 5);
  int runs = 0;
  recording.checkpoint = [&] {
    if (++runs > 2000) throw NumericalError("enough");
  };
  EXPECT_THROW(diagnose_bar(recording, {}), NumericalError);
}

TEST(Diagnose, RefusesARecordingTooShortToHoldAnythingOut) {
  Recording recording = film({}, 1);
  recording.frames.resize(10);
  EXPECT_NE(refusal([&] { diagnose_bar(recording, {}); }).find("10 usable frames"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
