// A diagnosis adds the effects that it names or is told, one in each round, and fits the model anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "effects/registry.hpp"
#include "filmed_bar.hpp"
#include "settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

// Returns the other effects of the library, so that a search takes less time.
std::vector<std::string> all_but(const std::vector<std::string>& wanted) {
  std::vector<std::string> out;
  for (const EffectSpec& spec : effect_specs()) {
    if (std::find(wanted.begin(), wanted.end(), spec.name) == wanted.end()) out.push_back(spec.name);
  }
  return out;
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
  const Model next(extend_model(box_settings(bar_under_gravity("{prior: 35.0e3, factor: 3}")), d.entries), bar_mesh());
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

}  // namespace
}  // namespace tissue_stiffness
