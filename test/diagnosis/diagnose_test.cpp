// In recordings of a bar with something hidden the diagnosis names it, proves it, and is silent where nothing is.
#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../box_model.hpp"
#include "diagnosis/finding.hpp"
#include "diagnosis/screening.hpp"
#include "effects/registry.hpp"
#include "forward/full_model.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3, kNoise = 1e-4;

std::vector<std::string> bar(const std::string& modulus) {
  return {"inertia: {density: 1000}", "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + modulus + "}",
          "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -3]}"};
}

Recording film(const std::vector<std::string>& hidden, unsigned seed) {
  std::vector<std::string> effects = bar("{prior: 20.0e3, factor: 3}");
  effects.insert(effects.end(), hidden.begin(), hidden.end());
  const Experiment experiment(box_settings(effects), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), kNoise, seed);
  return recording;
}

Diagnosis diagnose_bar(const Recording& recording, const DiagnosisOptions& options) {
  return diagnose(box_settings(bar("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording, options);
}

// Returns the other effects of the library, so that a search takes less time.
std::vector<std::string> all_but(const std::vector<std::string>& wanted) {
  std::vector<std::string> out;
  for (const EffectSpec& spec : effect_specs()) {
    if (std::find(wanted.begin(), wanted.end(), spec.name) == wanted.end()) out.push_back(spec.name);
  }
  return out;
}

TEST(Diagnose, FindsNothingWhereNothingIsMissing) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Diagnosis d = diagnose_bar(film({}, seed), {});
    EXPECT_EQ(d.verdict, Verdict::adequate) << seed;
    EXPECT_TRUE(d.set.empty());
    EXPECT_NEAR(d.steps.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.01);
  }
}

TEST(Diagnose, NamesHiddenDampingAndAddsIt) {
  DiagnosisOptions options;
  options.automatic = true;
  bool added = false;
  options.progress = [&](const std::string& what, std::size_t, std::size_t) {
    added = added || what == "add viscous_damping";
  };
  const Diagnosis d = diagnose_bar(film({"viscous_damping: {beta: 6.0e-3}"}, 1), options);
  EXPECT_TRUE(added);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_NE(std::find(d.set.begin(), d.set.end(), "viscous_damping"), d.set.end());
  ASSERT_GE(d.steps.size(), 2U);
  EXPECT_LT(d.steps.back().held_out_rms, 0.2 * d.steps.front().held_out_rms);
  EXPECT_LT(d.steps.back().held_out_rms, 1.1 * d.steps.back().noise_floor);
  EXPECT_NEAR(d.steps.back().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.02);
  EXPECT_EQ(d.final_verdict, Verdict::adequate);
}

// A load that the recorder missed for a while is held by the model. What the body does meanwhile is no effect.
TEST(Diagnose, LeavesOutFramesDuringWhichALoadWasSilent) {
  std::vector<std::string> effects = bar("{prior: 35.0e3, factor: 3}");
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
      std::make_unique<RecordingFit>(box_settings(bar("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording);
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
  FittedModel base =
      fit_recording(std::make_unique<RecordingFit>(box_settings(bar("{prior: 20.0e3, factor: 3}")), bar_mesh(), recording),
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

// Simulates with Newmark's average acceleration, in steps of length `step` alone.
Recording simulate(const std::vector<std::string>& hidden, double step, unsigned seed) {
  std::vector<std::string> effects = bar("{prior: 20.0e3, factor: 3}");
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

// E compensates for most of the springs below the clamp; what it leaves is within what may be noise.
TEST(Diagnose, FindsWhatTheModulusCompensatesFor) {
  const std::string sensor = "[{vertices: {topic: /vertices, noise: 4.0e-3}}]";
  std::vector<std::string> effects = bar("{prior: 20.0e3, factor: 3}");
  effects.push_back("elastic_support: {region: clamp, compliance: 2.0e-7}");
  const Experiment experiment(box_settings(effects, sensor), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), 4e-3, 10);
  const Diagnosis d = diagnose(box_settings(bar("{prior: 35.0e3, factor: 3}"), sensor), bar_mesh(), recording, {});
  std::printf("a compliant support: E %.1f kPa for 20 without it, %.3f sigma rms\n",
              1e-3 * d.steps.front().parameters.at("elasticity.young_modulus"), d.sigmas.total);
  EXPECT_LT(d.sigmas.total, 1.1);
  EXPECT_LT(d.steps.front().parameters.at("elasticity.young_modulus"), 0.9 * kTruth);
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "elastic_support");
  EXPECT_NEAR(d.candidates.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.03);
}

TEST(Diagnose, AddsWhatItIsTold) {
  DiagnosisOptions options;
  options.add = {"mass_damping"};
  const Diagnosis d = diagnose_bar(film({"mass_damping: {alpha: 1.5}"}, 2), options);
  EXPECT_EQ(d.final_effects, options.add);
  ASSERT_EQ(d.steps.size(), 2U);
  EXPECT_NEAR(d.steps.back().parameters.at("mass_damping.alpha"), 1.5, 0.15);
  options.add = {"pressure"};
  EXPECT_NE(refusal([&] { diagnose_bar(film({}, 1), options); }).find("--add"), std::string::npos);
}

// An effect that the search has fitted is added as it was fitted, on the side of the body that suits it best.
TEST(Diagnose, AddsAnEffectAsTheSearchFittedIt) {
  const Recording recording = film({"foundation: {facing: [0, 0, -1], stiffness: 2.0e4}"}, 3);
  DiagnosisOptions options;
  for (const EffectSpec& spec : effect_specs()) {
    if (spec.name != "foundation" && spec.name != "gravity") options.ignore.push_back(spec.name);
  }
  const Diagnosis searched = diagnose_bar(recording, options);
  for (const MissingEffect& candidate : searched.candidates) {
    options.add = {candidate.effect};
    const Diagnosis d = diagnose_bar(recording, options);
    ASSERT_EQ(d.final_effects, options.add) << d.failure;
    EXPECT_LT(d.steps.back().train_rms, 1.001 * d.steps.front().train_rms) << candidate.effect;
    EXPECT_NEAR(d.steps.back().held_out_rms, candidate.held_out_rms_after, 0.05 * candidate.held_out_rms_after)
        << candidate.effect;
  }
}

// The first one's fit compensated for the second.
TEST(Diagnose, ProposesWhatItAddedAsTheLastFitHasIt) {
  DiagnosisOptions options;
  options.add = {"mass_damping", "added_mass"};
  options.ignore = all_but(options.add);
  const Diagnosis d =
      diagnose_bar(film({"mass_damping: {alpha: 1.5}", "added_mass: {region: tip, mass: 0.004}"}, 2), options);
  ASSERT_EQ(d.steps.size(), 3U);
  const double alone = d.steps[1].parameters.at("mass_damping.alpha"),
               last = d.steps[2].parameters.at("mass_damping.alpha");
  EXPECT_GT(std::abs(alone - last), 0.01 * last);
  const Model next(extend_model(box_settings(bar("{prior: 35.0e3, factor: 3}")), d.entries), bar_mesh());
  for (const auto& [name, value] : d.steps[2].parameters) {
    if (name == "elasticity.young_modulus") continue;
    EXPECT_NEAR(next.parameters().values(next.parameters().prior_mean()).at(name), value, 1e-4 * std::abs(value)) << name;
  }
}

TEST(Diagnose, NamesTwoEffectsThatAreMissingTogether) {
  DiagnosisOptions options;
  options.automatic = true;
  std::string leader;
  std::map<std::string, std::set<std::string>> beside;  // by leader
  options.progress = [&](const std::string& what, std::size_t, std::size_t) {
    const std::string next = "what is missing beside ", refit = "refit with ";
    if (what.rfind(next, 0) == 0) leader = what.substr(next.size());
    if (what.rfind(refit, 0) == 0) beside[leader].insert(what.substr(refit.size()));
  };
  const Diagnosis d =
      diagnose_bar(film({"viscous_damping: {beta: 2.0e-3}", "added_mass: {region: tip, mass: 0.002}"}, 3), options);
  const auto added = [&](const std::string& effect) {
    return std::find(d.final_effects.begin(), d.final_effects.end(), effect) != d.final_effects.end();
  };
  EXPECT_TRUE(added("viscous_damping") || added("mass_damping") || added("viscoelasticity"))
      << "alike where one mode rings";
  EXPECT_TRUE(added("added_mass"));
  for (const char* damping : {"viscous_damping", "mass_damping", "viscoelasticity"})
    EXPECT_EQ(beside["added_mass"].count(damping), 1U) << damping << " is tried in the first one's place";
  EXPECT_EQ(d.final_verdict, Verdict::adequate);
  EXPECT_NEAR(d.steps.back().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.03);
}

struct Told {
  std::string what;
  std::size_t done, total;
};

// Returns the refits that the diagnosis of a bar tells of.
std::vector<Told> refits_told(const Recording& recording, Diagnosis& d) {
  std::vector<Told> told;
  DiagnosisOptions options;
  options.automatic = true;
  options.progress = [&](const std::string& what, std::size_t done, std::size_t total) {
    if (what.rfind("refit with ", 0) == 0) told.push_back({what, done, total});
  };
  d = diagnose_bar(recording, options);
  return told;
}

// Each refit is told with the number that are over and the number that there are.
TEST(Diagnose, CountsTheRefitsOfEachRound) {
  Diagnosis d;
  const auto told = refits_told(film({"viscous_damping: {beta: 6.0e-3}"}, 1), d);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.front().done, 0U);
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_LT(told[i].done, told[i].total);
    if (i > 0 && told[i].done > 0) {
      EXPECT_GE(told[i].done, told[i - 1].done);
      EXPECT_EQ(told[i].total, told[i - 1].total);
    }
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
  ModelSettings settings = box_settings(bar("{prior: 20.0e3, factor: 3}"));
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
  ModelSettings settings = box_settings(bar("{prior: 20.0e3, factor: 3}"));
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

// Returns the diagnosis of a bar with springs on a coarse mesh, filmed on a finer one.
Diagnosis diagnose_springs_on_coarse_mesh(const std::string& stiffness) {
  std::vector<std::string> effects = bar("{prior: 20.0e3, factor: 3}");
  ModelSettings settings = box_settings(effects);
  effects.push_back("foundation: {region: top, stiffness: " + stiffness + "}");
  const TetMesh coarse = bar_mesh(8, 2, 2);
  const double noise = 5.0 * kNoise;
  const Recording recording = film_finer(box_settings(effects), coarse, noise);
  settings.mesh.discretisation_error = true;
  settings.observations.front().noise = noise;
  return diagnose(settings, coarse, recording, {});
}

// Fibres imitate the mesh's error as well.
TEST(Diagnose, NamesAnEffectBesideTheErrorOfTheMesh) {
  const Diagnosis d = diagnose_springs_on_coarse_mesh("1200");
  EXPECT_EQ(d.verdict, Verdict::missing);
  ASSERT_FALSE(d.set.empty());
  EXPECT_EQ(d.set.front(), "foundation");
}

// Weak springs are less than what another mesh would change. So nothing is named, and E's interval tells of them.
TEST(Diagnose, NamesNothingThatTheLargestErrorOfTheMeshMayBe) {
  const Diagnosis d = diagnose_springs_on_coarse_mesh("400");
  EXPECT_EQ(d.verdict, Verdict::numerics);
  EXPECT_GT(d.z, MisfitTest::bound);
  const ParameterEstimate& modulus = d.estimate.parameters.front();
  EXPECT_LT(modulus.lower95, kTruth);
  EXPECT_GT(modulus.upper95, kTruth);
  const auto springs = [](const RivalExplanation& trace) { return trace.effect == "foundation"; };
  EXPECT_TRUE(std::any_of(d.traces.begin(), d.traces.end(), springs));
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
