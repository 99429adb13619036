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
  d.where = "around (-3, 13, 41) mm";
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
                             "effects:\n  - a: {x: 1}\n",
                             "effects:\n  - a: {x: 1.0}\n  - <b>: {y: 2}\n",
                             {{"tissue_stiffness", "0.1.0"}},
                             {{"viscous_damping.beta", "s"}}};
  const std::string page = diagnosis_html(example_diagnosis(), texts, example_showing());
  std::size_t at = 0;
  for (const std::string fragment : {"an effect is missing",
                                     "excite two modes",
                                     "12.00 kPa",
                                     "95 %: 11.85 to 12.15 kPa",
                                     "model adequate</span> with viscous",
                                     "This is the estimate of model_next.yaml. It counts",
                                     "they are 19.00 kPa as given and 12.00 kPa with viscous damping",
                                     "id=\"replay\"",
                                     "id=\"fails\"",
                                     "around (-3, 13, 41) mm",
                                     "<h3>Viscous damping</h3>",
                                     "<p>94 %; beta = 2.00 ms; confusable with mass damping (0.97)</p>",
                                     "<h3>None of these</h3>",
                                     "<p>1.0 %</p>",
                                     "All 2 effects that were tried",
                                     "quick vibrations",
                                     "0.110 mm",
                                     "not refitted",
                                     "nothing",
                                     "id=\"staircase\"",
                                     "best fit of E",
                                     "19.00 kPa",
                                     "<code>&lt;b&gt;</code></td><td class=\"soft\">not there</td><td><ins>{y: 2}</ins>",
                                     "diagnose model.yaml x.bag"}) {
    const std::size_t found = page.find(fragment, at);
    EXPECT_NE(found, std::string::npos) << fragment;
    if (found != std::string::npos) at = found;
  }
  EXPECT_EQ(data_of(page).at("diagnosis"), json::parse(diagnosis_json(example_diagnosis())));
  EXPECT_EQ(page.find("<own>"), std::string::npos);
  EXPECT_EQ(page.find("of the fit itself"), std::string::npos);
  EXPECT_EQ(page.find("<code>a.x"), std::string::npos) << "1 and 1.0 are the same";
  Diagnosis fitted = example_diagnosis();
  fitted.estimate.state = EstimateState::no_data;
  EXPECT_NE(diagnosis_html(fitted, texts, {}).find("95 %: 11.85 to 12.15 kPa, of the fit itself"), std::string::npos);
  EXPECT_FALSE(json::parse(diagnosis_json(fitted))["final"].contains("state"));
}

TEST(DiagnosisHtml, ListsProbableEffectsAndFoldsTheOthers) {
  Diagnosis d = example_diagnosis();
  MissingEffect unlikely = d.candidates.front();
  unlikely.effect = "gravity";
  unlikely.probability = 1e-5;
  unlikely.z = 1323.0;
  unlikely.parameters = {{"gravity.acceleration_x", 0.267},
                         {"gravity.acceleration_y", 1.446},
                         {"gravity.acceleration_z", -3.915},
                         {"gravity.scale_x", 2.0}};
  d.candidates.push_back(unlikely);
  DiagnosisTexts texts;
  texts.units["gravity.acceleration_x"] = "m/s^2";
  const std::string page = diagnosis_html(d, texts, {});
  EXPECT_NE(page.find("<b>gravity</b>"), std::string::npos);
  EXPECT_NE(page.find(">acceleration = (0.267, 1.45, -3.92) m/s^2, scale x = 2.00</td>"), std::string::npos);
  EXPECT_EQ(page.find("<h3>Gravity"), std::string::npos);
  EXPECT_EQ(page.find("Probabilities:"), std::string::npos) << "the list says them";
  EXPECT_NE(page.find("<details><summary>All 3 effects"), std::string::npos);
  EXPECT_NE(page.find("</small></td><td class=\"n\">&lt; 0.1 %</td><td class=\"n\">&gt; 100</td>"), std::string::npos);
  d.set.clear();
  d.candidates.front().probability = 0.009;
  EXPECT_NE(diagnosis_html(d, {}, {}).find("<h3>None of these</h3>"), std::string::npos);
  d.none_of_these = 0.0;
  const std::string none = diagnosis_html(d, {}, {});
  EXPECT_NE(none.find("No effect has a probability of 1 %."), std::string::npos);
  d.candidates.front().effect = "mass_damping";
  d.candidates.front().probability = 0.4;
  EXPECT_NE(diagnosis_html(d, {}, {}).find("<p>40 %; explains 91.0 % of the squared error;"), std::string::npos);
  EXPECT_NE(none.find("<details open><summary>All 3 effects"), std::string::npos);
}

TEST(DiagnosisHtml, SaysWhichModulusIsWhich) {
  Diagnosis d = example_diagnosis();
  d.traces = {{"gravity", 0.3, {{"elasticity.young_modulus", 1.1}}}};
  EXPECT_NE(diagnosis_sentence(d).find("E's interval allows for what may act unseen: gravity (30 %, E 10 % higher)."),
            std::string::npos);
  EXPECT_NE(diagnosis_html(d, {}, {}).find("model_next.yaml, averaged over the effects that may also act."),
            std::string::npos);
  d.traces.clear();
  d.steps.resize(1);
  d.final_effects.clear();
  const std::string given = diagnosis_html(d, {}, {});
  EXPECT_NE(given.find("the estimate of the given model. It counts"), std::string::npos);
  EXPECT_NE(given.find("do not: they are 19.00 kPa as given."), std::string::npos);
  d.estimate.parameters.clear();
  EXPECT_EQ(diagnosis_html(d, {}, {}).find("the estimate of the given model"), std::string::npos);
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
