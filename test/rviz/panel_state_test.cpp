#include "rviz/panel_state.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

StiffnessEstimate estimate(double time, double mean, double half_width, const std::string& state = "converging") {
  StiffnessEstimate out;
  out.header.stamp = ros::Time(time);
  out.state = state;
  out.names = {"viscous_damping.beta", "elasticity.young_modulus"};
  out.units = {"s", "Pa"};
  out.mean = {0.01, mean};
  out.std = {0.001, half_width / 2};
  out.lower95 = {0.008, mean - half_width};
  out.upper95 = {0.012, mean + half_width};
  return out;
}

DiagnosisMessage diagnosis() {
  MissingEffectMessage best, second;
  best.effect = "viscoelasticity";
  best.entry = "viscoelasticity: {gamma: {prior: 0.5, factor: 3}}";
  best.parameter_names = {"viscoelasticity.gamma"};
  best.parameter_values = {0.8};
  best.log_bayes_factor = 1234.0;
  best.explained = 0.934;
  best.probability = 0.94;
  best.held_out_rms_before = 9.5e-4;
  best.held_out_rms_after = 2.0e-4;
  best.confusable_with = {"mass_damping"};
  best.cosines = {0.93};
  second.effect = "mass_damping";
  second.explained = 1.2;  // never more than all of it
  second.held_out_rms_after = std::nan("");
  DiagnosisMessage out;
  out.verdict = "missing";
  out.summary = "viscoelasticity is missing";
  out.set = {"viscoelasticity"};
  out.none_of_these = 0.01;
  out.candidates = {best, second};
  out.noise_floor = 1.7e-4;
  return out;
}

TEST(PanelState, BeforeTheFirstFrame) {
  const PanelState state;
  EXPECT_EQ(state.headline(), "-");
  EXPECT_EQ(state.interval(), "");
  EXPECT_EQ(state.state().text, "no data");
  EXPECT_EQ(state.misfit(), "");
  EXPECT_TRUE(state.rows().empty());
  EXPECT_EQ(state.best_candidate(), "");
  EXPECT_EQ(state.last_added(), "");
  EXPECT_TRUE(std::isnan(state.noise_floor()));
}

TEST(PanelState, ShowsYoungsModulusWithItsIntervalWhereverItIsInTheList) {
  PanelState state;
  state.take(estimate(1.0, 12016.0, 160.0, "converged"));
  EXPECT_EQ(state.headline(), "12.02 kPa");
  EXPECT_EQ(state.interval(), "95 %: 11.86 to 12.18 kPa");
  EXPECT_EQ(state.quantity(), "Young's modulus");
  EXPECT_EQ(state.modulus_axis(), "E [kPa]");
  EXPECT_EQ(state.state().text, "converged");
  ASSERT_EQ(state.modulus_curve().points().size(), 1U);
  EXPECT_NEAR(state.modulus_curve().points()[0].upper, 12.176, 1e-9);
}

TEST(PanelState, ShowsTheFirstParameterWhenNoModulusIsEstimated) {
  PanelState state;
  StiffnessEstimate message = estimate(1.0, 12e3, 100.0);
  message.names[1] = "pressure.amplitude";
  state.take(message);
  EXPECT_EQ(state.quantity(), "viscous_damping.beta");
  EXPECT_EQ(state.modulus_axis(), "beta [ms]");
  EXPECT_EQ(state.headline(), "10.0 ms");
}

TEST(PanelState, AModelWithoutParametersIsNoData) {
  PanelState state;
  state.take(StiffnessEstimate());
  EXPECT_EQ(state.headline(), "-");
  EXPECT_EQ(state.state().text, "no data");
}

TEST(PanelState, StatesHaveColoursOfTheirOwn) {
  std::vector<unsigned> colours;
  for (const char* name : {"converging", "converged", "doubtful", "stale", "drifting", "model_invalid"}) {
    PanelState state;
    state.take(estimate(1.0, 12e3, 100.0, name));
    for (const unsigned other : colours) EXPECT_NE(state.state().colour, other) << name;
    colours.push_back(state.state().colour);
  }
}

TEST(PanelState, SaysWhyTheStateIsSo) {
  PanelState state;
  EXPECT_EQ(state.state_reason(), "");
  StiffnessEstimate message = estimate(1.0, 12e3, 100.0, "doubtful");
  message.state_reason = "the bias of /tool/wrench is implausible";
  state.take(message);
  EXPECT_EQ(state.state_reason(), message.state_reason);
}

TEST(PanelState, OneCurveHasOneUnit) {
  PanelState state;
  state.take(estimate(1.0, 1.2e6, 1e5));
  state.take(estimate(2.0, 0.8e6, 1e5));
  EXPECT_EQ(state.modulus_unit(), "MPa");
  EXPECT_EQ(state.modulus_curve().points().size(), 2U);
  state.take(estimate(3.0, 9e3, 1e3));
  EXPECT_EQ(state.modulus_unit(), "kPa");
  EXPECT_EQ(state.modulus_curve().points().size(), 1U);
}

TEST(PanelState, RanksWhatMayBeMissing) {
  PanelState state;
  state.take(diagnosis());
  const std::vector<EffectRow> rows = state.rows();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].effect, "viscoelasticity");
  EXPECT_TRUE(rows[0].suspect);
  EXPECT_FALSE(rows[0].added);
  EXPECT_NEAR(rows[0].explained, 0.934, 1e-12);
  EXPECT_EQ(rows[0].error, "0.950 → 0.200 mm");
  EXPECT_EQ(rows[0].probability, "94 %");
  for (const char* part : {"gamma: {prior: 0.5", "viscoelasticity.gamma = 0.8", "log Bayes factor 1234", "mass damping"}) {
    EXPECT_NE(rows[0].details.find(part), std::string::npos) << part << " in " << rows[0].details;
  }
  EXPECT_EQ(rows[1].title, "mass damping");
  EXPECT_FALSE(rows[1].suspect);
  EXPECT_EQ(rows[1].error, "");
  EXPECT_EQ(rows[1].explained, 1.0);
  EXPECT_EQ(rows[1].probability, "") << "it was not refitted";
  EXPECT_EQ(rows[2].title, "none of these");
  EXPECT_EQ(rows[2].effect, "") << "nothing that could be added";
  EXPECT_EQ(rows[2].probability, "1 %");
  EXPECT_EQ(state.best_candidate(), "viscoelasticity");
  EXPECT_EQ(state.summary(), "viscoelasticity is missing");
  EXPECT_NEAR(state.noise_floor(), 0.17, 1e-12);
}

TEST(PanelState, ADiagnosisOfAnotherModelIsNotShown) {
  PanelState state;
  state.take(diagnosis());
  state.set_added({"viscoelasticity"});
  ASSERT_EQ(state.rows().size(), 1U);
  EXPECT_TRUE(state.rows()[0].added);
  EXPECT_EQ(state.best_candidate(), "");
  EXPECT_EQ(state.last_added(), "viscoelasticity");
  EXPECT_EQ(state.summary(), "");
  DiagnosisMessage next = diagnosis();
  next.verdict = "adequate";
  next.set.clear();
  next.candidates = {next.candidates[1]};
  next.added = {"viscoelasticity"};
  state.take(next);
  EXPECT_EQ(state.verdict().text, "nothing");
  EXPECT_EQ(state.rows().size(), 3U) << "what was added, one candidate, none of these";
}

TEST(PanelState, KeepsTheMisfitInMillimetres) {
  PanelState state;
  MisfitMessage message;
  message.header.stamp = ros::Time(2.0);
  message.rms = 2.1e-4;
  message.rms_sigma = 1.02;
  state.take(message);
  EXPECT_EQ(state.misfit(), "misfit 0.210 mm, 1.02 sigma");
  EXPECT_NEAR(state.misfit_curve().points()[0].value, 0.21, 1e-12);
}

TEST(PanelState, MarksWhereEffectsCameAndWent) {
  PanelState state;
  state.take(estimate(1.0, 18e3, 100.0));
  EXPECT_FALSE(state.model_changed());
  StiffnessEstimate changed = estimate(1.0, 12e3, 100.0);
  changed.names[0] = "mass_damping.alpha";
  state.take(changed);
  EXPECT_TRUE(state.model_changed());
  EXPECT_FALSE(state.model_changed()) << "told once";
  ASSERT_EQ(state.modulus_curve().events().size(), 1U);
  EXPECT_EQ(state.modulus_curve().events()[0].text, "+ mass damping - viscous damping");
  EXPECT_EQ(state.modulus_curve().events()[0].time, 1.0);
  ASSERT_EQ(state.modulus_curve().points().size(), 2U) << "a step";
}

}  // namespace
}  // namespace tissue_stiffness
