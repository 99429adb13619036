// These tests cover what the mesh is blamed for, and what the tangents say.
#include "diagnosis/screening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "../estimation/bar.hpp"
#include "diagnosis/initial_segment.hpp"
#include "settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

class BarWithADamping : public ::testing::Test {
 protected:
  void SetUp() override {
    std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
    given_ = box_settings(effects);
    effects.push_back("viscous_damping: {beta: 6.0e-3}");
    const Experiment experiment(box_settings(effects), bar_mesh(), {20e3});
    recording_.frames = see_all(experiment, experiment.film(0.0, 0.02, 40), kNoise, 1);
    base_.recording_fit = std::make_unique<RecordingFit>(given_, bar_mesh(), recording_);
    const Model& model = base_.recording_fit->model();
    base_.fit = base_.recording_fit->fit(model.parameters().prior_mean(), 0.1 * model.parameters().prior_std());
    base_.rows = base_.recording_fit->rows(base_.fit.w);
  }

  ModelSettings given_;
  Recording recording_;
  FittedModel base_;
};

// Amplitudes of tangents are counted from where the effect is absent: a scale is 1 there.
TEST_F(BarWithADamping, CountsAmplitudesFromWhereAnEffectIsAbsent) {
  const Screening screening(base_, {});
  std::map<std::string, double> absent;
  for (const Candidate& candidate : screening.candidates) absent[candidate.effect] = candidate.absent;
  EXPECT_EQ(absent.at("image_scale"), 1.0);
  EXPECT_EQ(absent.at("viscous_damping"), 0.0);
}

// A proposal's scale follows from the modulus. What no model file may hold is not proposed, and ends nothing.
TEST_F(BarWithADamping, LeavesOutProposalsBeyondWhatAModelFileMayHold) {
  ModelSettings absurd = box_settings(bar_under_gravity("{prior: 1e12, factor: 3}"));
  base_.recording_fit = std::make_unique<RecordingFit>(absurd, bar_mesh(), recording_);
  base_.fit.w = base_.recording_fit->model().parameters().prior_mean();
  const auto candidates = propose_candidates(*base_.recording_fit, base_.fit.w, {});
  const auto is = [](const char* name) { return [name](const Candidate& c) { return c.effect == name; }; };
  EXPECT_TRUE(std::any_of(candidates.begin(), candidates.end(), is("viscous_damping")));
  EXPECT_TRUE(std::none_of(candidates.begin(), candidates.end(), is("active_contraction")));
}

// Where some effects are wanted the others' tangents are not read, but still count among the alternatives.
TEST_F(BarWithADamping, ReadsTheTangentsOfWantedEffectsAlone) {
  const Screening all(base_, {}), wanted(base_, {}, {}, {"viscous_damping"});
  EXPECT_EQ(all.ranked.size(), all.effect_count);
  EXPECT_EQ(wanted.effect_count, all.effect_count);
  ASSERT_EQ(wanted.ranked.size(), 1U);
  const auto same = [](const Ranked& r) { return r.effect == "viscous_damping"; };
  const auto known = std::find_if(all.ranked.begin(), all.ranked.end(), same);
  // The bases differ a little.
  EXPECT_NEAR(wanted.ranked.front().evidence, known->evidence, 0.02 * std::abs(known->evidence));
}

// What an earlier round's models hold, they also hold once one of its effects has been added.
TEST_F(BarWithADamping, ReadsTangentsInTheVectorsOfAnEarlierScreening) {
  const Screening first(base_, {});
  ModelSettings damped = given_;
  add_effect(damped, "viscous_damping: {beta: {prior: 5.0e-3, factor: 2}}");
  FittedModel next;
  next.recording_fit = std::make_unique<RecordingFit>(damped, *base_.recording_fit);
  const Model& model = next.recording_fit->model();
  next.fit = next.recording_fit->fit(model.parameters().prior_mean(), 0.1 * model.parameters().prior_std());
  next.rows = next.recording_fit->rows(next.fit.w);
  const Screening alone(next, {}), after(next, {}, {first.finer.recording_fit, nullptr, first.library, true});
  ASSERT_EQ(alone.candidates.size(), after.candidates.size());
  double worst = 0.0;
  for (std::size_t c = 0; c < alone.candidates.size(); ++c) {
    const Eigen::MatrixXd &a = alone.candidates[c].tangent.columns, &b = after.candidates[c].tangent.columns;
    EXPECT_NE(a, b) << alone.candidates[c].effect;
    worst = std::max(worst, (a - b).norm() / a.norm());
  }
  std::printf("tangents in an earlier screening's vectors: off by %.1e at most\n", worst);
  EXPECT_LT(worst, 0.02);
}

// A model of a bar of 20 kPa that is let go, at some modulus, and the recording of a bar on which `hidden` acts, too.
struct BarThatLacks {
  Recording recording;
  FittedModel base;

  BarThatLacks(const std::string& hidden, int frames, double modulus) {
    std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
    const ModelSettings given = box_settings(effects);
    effects.push_back(hidden);
    const Experiment experiment(box_settings(effects), bar_mesh(), {20e3});
    recording.frames = see_all(experiment, experiment.film(0.0, 0.02, frames), kNoise, 1);
    base.recording_fit = std::make_unique<RecordingFit>(given, bar_mesh(), recording);
    base.fit.w = Eigen::VectorXd::Constant(1, std::log(modulus));
    base.rows = base.recording_fit->rows(base.fit.w);
  }
};

// A second gravity has a number in its name, and the scan finds its strength at each modulus that it tries.
TEST(InitialSegment, FindsTheStrengthOfASecondEffectOfAKind) {
  const BarThatLacks bar("gravity: {acceleration: [0, 4, 8]}", 60, 55e3);  // in a wrong minimum
  const FittedModel& base = bar.base;
  const std::vector<Candidate> candidates = propose_candidates(*base.recording_fit, base.fit.w, {});
  const auto gravity =
      std::find_if(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.effect == "gravity"; });
  ASSERT_NE(gravity, candidates.end());
  EXPECT_TRUE(gravity->has_amplitude("gravity#2.acceleration_y"));
  EXPECT_FALSE(gravity->has_amplitude("elasticity.young_modulus"));
  std::map<std::string, double> found = scan_initial_segment(base, *gravity).front().parameters;
  EXPECT_NEAR(found["elasticity.young_modulus"] / 20e3, 1.0, 0.03);
  EXPECT_NEAR(found["gravity#2.acceleration_x"], 0.0, 0.2);
  EXPECT_NEAR(found["gravity#2.acceleration_y"], 4.0, 0.2);
  EXPECT_NEAR(found["gravity#2.acceleration_z"], 8.0, 0.4);
}

// A lump as heavy as the bar shifts its frequencies so much that a start elsewhere does not lead to its place.
TEST(InitialSegment, FindsThePlaceOfAHeavyLump) {
  const BarThatLacks bar("added_mass: {center: [0.09, 0.01, 0.01], mass: 0.04}", 100, 20e3);
  const FittedModel& base = bar.base;
  const std::vector<Candidate> candidates = propose_candidates(*base.recording_fit, base.fit.w, {});
  const auto lump = [](const Candidate& c) {
    return c.effect == "added_mass" && c.proposal.refine.find("center") != nullptr;
  };
  const auto first = std::find_if(candidates.begin(), candidates.end(), lump);
  ASSERT_NE(first, candidates.end());
  const auto x_of = [](const Candidate& c) {
    return std::get<VectorPrior>(c.proposal.refine.find("center")->content).mean.x();
  };
  const Candidate* farthest = &*first;
  std::vector<const Candidate*> others;
  for (const Candidate& candidate : candidates) {
    EXPECT_EQ(candidate.proposal.differs_in_start_from(first->proposal), lump(candidate)) << candidate.effect;
    if (!lump(candidate)) continue;
    others.push_back(&candidate);
    if (x_of(candidate) < x_of(*farthest)) farthest = &candidate;
  }
  EXPECT_GT(others.size(), 10U);
  const RankedFit alone = scan_initial_segment(base, *farthest).front();
  const RankedFit found = scan_initial_segment(base, *farthest, others).front();
  EXPECT_LT(found.deviance, 0.5 * alone.deviance);
  EXPECT_NEAR(found.parameters.at("added_mass.center_x"), 0.09, 0.02);
  EXPECT_NEAR(std::log(found.parameters.at("added_mass.mass") / 0.04), 0.0, std::log(3.0));
}

}  // namespace
}  // namespace tissue_stiffness
