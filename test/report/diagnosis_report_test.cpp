// What a diagnosis says: its sentence, its JSON and its page.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "example.hpp"
#include "report/write_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

Diagnosis example_diagnosis() {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.set = {"viscous_damping", "mass_damping"};
  d.best = {{"viscous_damping"}, 0.91, 1.1e-4};
  MissingEffect best;
  best.effect = "viscous_damping";
  best.parameters = {{"viscous_damping.beta", 2e-3}};
  best.explained = 0.91;
  best.p_value = 0.0;
  best.held_out_rms_before = 3e-4;
  best.held_out_rms_after = 1.1e-4;
  best.confusable_with = {{"mass_damping", 0.97}};
  MissingEffect useless;
  useless.effect = "<own>_effect";
  useless.explained = -0.01;
  d.candidates = {best, useless};
  d.where = "all over the body";
  d.when = "early";
  d.next_experiment = "excite two modes";
  d.steps = {{{}, {{"elasticity.young_modulus", 19e3}}, 3e-4, 3.1e-4, 1e-4},
             {{"viscous_damping"}, {{"elasticity.young_modulus", 12e3}}, 1e-4, 1.1e-4, 1e-4}};
  d.final_verdict = Verdict::adequate;
  d.final_effects = {"viscous_damping"};
  d.candidates.front().probability = 0.94;
  d.candidates.front().z = 1.2;
  d.none_of_these = 0.01;
  d.entries = {"viscous_damping: {beta: 1}"};
  d.estimate.state = EstimateState::converged;
  d.estimate.parameters = {{"elasticity.young_modulus", "Pa", 12e3, 77.0, 11.85e3, 12.15e3}};
  return d;
}

TEST(DiagnosisSentence, NamesWhatIsMissingAndWhatFitsAsWell) {
  Diagnosis d = example_diagnosis();
  EXPECT_EQ(diagnosis_sentence(d).find("Missing: viscous damping (the motion dies away"), 0u);
  EXPECT_NE(diagnosis_sentence(d).find("fit as well: mass damping. To tell them apart"), std::string::npos);
  EXPECT_NE(diagnosis_sentence(d).find(" Probabilities: viscous damping 94 %, none of these 1 %."), std::string::npos);
  d.candidates.front().probability = d.none_of_these = 0.0;
  d.set = {"rigid_drift", "viscous_damping", "mass_damping"};
  d.best = {{"rigid_drift", "viscous_damping"}, 0.95, 2e-4};
  EXPECT_EQ(diagnosis_sentence(d),
            "Missing: rigid drift and viscous damping together. They would remove 95.0 % of the squared error (held-out "
            "error 0.310 mm to 0.200 mm). These data fit as well: mass damping. To tell them apart: excite two modes.");
  d.failure = "rigid_drift cannot be added: tetrahedron 3 turned inside out";
  EXPECT_NE(diagnosis_sentence(d).find("two modes. But rigid_drift cannot be added: tetrahedron 3 turned inside out."),
            std::string::npos);
  d.left_out = "12 of 60 frames (no load on /wrench for 0.3 s)";
  EXPECT_NE(diagnosis_sentence(d).find(" Left out: 12 of 60 frames (no load on /wrench for 0.3 s)."), std::string::npos);
  EXPECT_NE(diagnosis_json(d).find("\"left_out\": \"12 of 60 frames"), std::string::npos);
}

TEST(DiagnosisSentence, SaysWhyNothingIsNamed) {
  Diagnosis d = example_diagnosis();
  d.verdict = Verdict::unexplained;
  d.none_of_these = 0.999;
  d.candidates.front().probability = 0.001;
  EXPECT_NE(diagnosis_sentence(d).find("none of these 100 %. None of them explains the data."), std::string::npos);
  d.none_of_these = 0.3;
  d.candidates.front().probability = 0.7;
  EXPECT_EQ(diagnosis_sentence(d).find("Not explained; nearest: viscous damping ("), 0u);
  EXPECT_NE(diagnosis_sentence(d).find("damping 70 %, none of these 30 %. That is not certain enough for a name."),
            std::string::npos);
}

TEST(DiagnosisHtml, TellsTheStoryInOrder) {
  const DiagnosisTexts texts{"model.yaml",
                             "x.bag",
                             "diagnose model.yaml x.bag",
                             "effects:\n  - a\n",
                             "effects:\n  - a\n  - <b>\n",
                             {{"tissue_stiffness", "0.1.0"}},
                             {{"viscous_damping.beta", "s"}}};
  const std::string page = diagnosis_html(example_diagnosis(), texts, example_showing());
  std::size_t at = 0;
  for (const std::string fragment :
       {"an effect is missing", "12.00 kPa", "95 %: 11.85 to 12.15 kPa", "The best fit of the given model says 19.00 kPa",
        "id=\"replay\"", "id=\"fails\"", "quick vibrations", "would remove 91.0 % of the squared error",
        "0.300 mm to 0.110 mm", "it is confusable with mass damping", "probability 94 %, leaves z = 1.2",
        "would remove nothing", "excite two modes", "id=\"staircase\"", "modulus of the fit",
        "best fits to the whole recording", "<ins>  - &lt;b&gt;</ins>", "diagnose model.yaml x.bag"}) {
    const std::size_t found = page.find(fragment, at);
    EXPECT_NE(found, std::string::npos) << fragment;
    if (found != std::string::npos) at = found;
  }
  EXPECT_EQ(data_of(page).at("diagnosis"), json::parse(diagnosis_json(example_diagnosis())));
  EXPECT_EQ(page.find("<own>"), std::string::npos);
  EXPECT_EQ(page.find("of the fit itself"), std::string::npos);
  EXPECT_NE(page.find("beta (viscous_damping) = 2.00 ms"), std::string::npos);
  EXPECT_NE(page.find("<li><code>viscous_damping: {beta: 1}</code></li>"), std::string::npos);
  Diagnosis fitted = example_diagnosis();
  fitted.estimate.state = EstimateState::no_data;
  EXPECT_NE(diagnosis_html(fitted, texts, {}).find("95 %: 11.85 to 12.15 kPa, of the fit itself"), std::string::npos);
  EXPECT_FALSE(json::parse(diagnosis_json(fitted))["final"].contains("state"));
}

TEST(Interrupted, ADiagnosisSaysWhatIsNotKnown) {
  Diagnosis nothing;
  nothing.interrupted = "reading the model and the recording";
  const json root = json::parse(diagnosis_json(nothing));
  EXPECT_EQ(root.at("complete"), false);
  EXPECT_EQ(root.at("verdict"), "unfinished");
  EXPECT_EQ(root.at("steps").size(), 0u);
  const std::string empty = diagnosis_html(nothing, {}, {});
  EXPECT_NE(empty.find("The work was interrupted during: reading the model"), std::string::npos);
  EXPECT_EQ(own_part(empty).find("id=\"fails\""), std::string::npos);
  Diagnosis fitted = example_diagnosis();
  fitted.interrupted = "refit with added_mass";
  fitted.verdict = fitted.final_verdict = Verdict::unfinished;
  const std::string page = diagnosis_html(fitted, {}, {});
  for (const std::string words :
       {"no verdict yet", "There is no verdict yet", "not known yet whether something is missing"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(json::parse(diagnosis_json(example_diagnosis())).at("complete"), true);
}

}  // namespace
}  // namespace tissue_stiffness
