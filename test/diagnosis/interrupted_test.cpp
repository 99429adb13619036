// A diagnosis that is interrupted keeps what it knows.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <utility>

#include "../estimation/bar.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

/// The fixture is a bar with damping that the model does not know.
class InterruptedDiagnosis : public ::testing::Test {
 protected:
  InterruptedDiagnosis() {
    std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
    effects.push_back("viscous_damping: {beta: 6.0e-3}");
    const Experiment experiment(box_settings(effects), bar_mesh(), {20e3});
    recording_.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), 1e-4, 1);
    options_.automatic = true;
  }

  Diagnosis run() {
    return diagnose(box_settings(bar_under_gravity("{prior: 35.0e3, factor: 3}")), bar_mesh(), recording_, options_);
  }

  /// Interrupts as soon as `enough` is true of what is known.
  Diagnosis run_until(const std::function<bool(const Diagnosis&)>& enough) {
    StopRequest stop;
    recording_.checkpoint = [&] { stop.check(); };
    options_.so_far = [&](const Diagnosis& known) {
      EXPECT_FALSE(known.interrupted.empty());
      if (enough(known)) stop.stop();
    };
    return run();
  }

  Recording recording_;
  DiagnosisOptions options_;
};

bool refitted(const MissingEffect& candidate) {
  return std::isfinite(candidate.held_out_rms_after);
}

TEST_F(InterruptedDiagnosis, HoldsTheFitOfTheGivenModel) {
  const Diagnosis d = run_until([](const Diagnosis& known) { return !known.steps.empty(); });
  EXPECT_EQ(d.verdict, Verdict::unfinished);
  EXPECT_EQ(d.final_verdict, Verdict::unfinished);
  EXPECT_EQ(d.interrupted.rfind("compare the given model", 0), 0U) << d.interrupted;
  ASSERT_EQ(d.steps.size(), 1U);
  EXPECT_GT(d.steps.front().held_out_rms, d.steps.front().noise_floor);
  EXPECT_GT(d.sigmas.structured, 1.0);
  EXPECT_FALSE(d.where.empty());
  EXPECT_EQ(d.estimate.parameters.size(), 1U);
  EXPECT_TRUE(d.candidates.empty());
}

TEST_F(InterruptedDiagnosis, HoldsTheCandidatesByTheirTangents) {
  const Diagnosis d = run_until([](const Diagnosis& known) { return !known.candidates.empty(); });
  EXPECT_EQ(d.verdict, Verdict::unfinished);
  ASSERT_FALSE(d.candidates.empty());
  EXPECT_TRUE(std::none_of(d.candidates.begin(), d.candidates.end(), refitted));
}

TEST_F(InterruptedDiagnosis, HoldsTheRefitsThatWereDone) {
  StopRequest stop;
  recording_.checkpoint = [&] { stop.check(); };
  options_.progress = [&](const std::string& what, std::size_t done, std::size_t) {
    if (what.rfind("refit with ", 0) == 0 && done > 0) stop.stop();  // while others of the same batch are under way
  };
  const Diagnosis d = run();
  EXPECT_EQ(d.verdict, Verdict::unfinished);
  EXPECT_EQ(d.interrupted.rfind("refit with ", 0), 0U) << d.interrupted;
  EXPECT_GE(std::count_if(d.candidates.begin(), d.candidates.end(), refitted), 1);
}

TEST_F(InterruptedDiagnosis, HoldsTheVerdictOnceThereIsOne) {
  const Diagnosis d = run_until([](const Diagnosis& known) { return known.steps.size() > 1; });
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_EQ(d.steps.size(), 2U);
  EXPECT_EQ(d.entries.size(), d.final_effects.size());
}

TEST_F(InterruptedDiagnosis, EndsAtAnyFrame) {
  std::atomic<long> frames{0};
  recording_.checkpoint = [&] { ++frames; };
  const Diagnosis whole = run();
  EXPECT_TRUE(whole.interrupted.empty());
  std::mt19937 random(1);
  for (int trial = 0; trial < 12; ++trial) {
    std::atomic<long> left{std::uniform_int_distribution<long>(0, frames - 1)(random)};
    StopRequest stop;
    recording_.checkpoint = [&] {
      if (--left < 0) stop.stop();
      stop.check();
    };
    const Diagnosis d = run();
    EXPECT_FALSE(d.interrupted.empty()) << trial;
    EXPECT_TRUE(d.verdict == Verdict::unfinished || d.verdict == whole.verdict) << to_string(d.verdict);
  }
}

/// Runs with models of which one cannot be run once `begun` is set.
class FailingDiagnosis : public InterruptedDiagnosis {
 protected:
  FailingDiagnosis() {
    recording_.checkpoint = [this] {
      if (begun_.exchange(false)) throw NumericalError("a model that cannot be run");
    };
  }

  std::atomic<bool> begun_{false};
};

TEST_F(FailingDiagnosis, KeepsTheModelThatCannotBeExtended) {
  options_.progress = [&](const std::string& what, std::size_t, std::size_t) {
    if (what.rfind("add ", 0) == 0) begun_ = true;
  };
  const Diagnosis d = run();
  EXPECT_TRUE(d.interrupted.empty());
  EXPECT_EQ(d.failure, "viscous_damping cannot be added: a model that cannot be run");
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_EQ(d.final_verdict, Verdict::missing);
  EXPECT_TRUE(d.final_effects.empty());
  EXPECT_TRUE(d.entries.empty());
  EXPECT_EQ(d.steps.size(), 1U);
}

TEST_F(FailingDiagnosis, BelievesNoModelWhoseRestCannotBeJudged) {
  options_.so_far = [&, added = false](const Diagnosis& known) mutable {
    if (known.steps.size() > 1 && !std::exchange(added, true)) begun_ = true;
  };
  const Diagnosis d = run();
  EXPECT_TRUE(d.interrupted.empty());
  EXPECT_EQ(d.failure, "what is left beside viscous_damping cannot be judged: a model that cannot be run");
  EXPECT_EQ(d.final_verdict, Verdict::unexplained);
  EXPECT_EQ(d.final_effects, std::vector<std::string>{"viscous_damping"});
  EXPECT_EQ(d.entries.size(), 1U);
  EXPECT_EQ(d.steps.size(), 2U);
}

}  // namespace
}  // namespace tissue_stiffness
