#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "example.hpp"
#include "report/course.hpp"
#include "report/page.hpp"
#include "report/text.hpp"
#include "report/write_diagnosis.hpp"
#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ResultsJson, HoldsTheContract) {
  const Results results = example(60);
  const json root = json::parse(results_json(results));
  const json& modulus = root.at("parameters").at("elasticity.young_modulus");
  EXPECT_EQ(modulus.at("unit"), "Pa");
  EXPECT_EQ(modulus.at("mean"), 4.1234e5);
  EXPECT_EQ(modulus.at("std"), 2.1e3);
  EXPECT_EQ(modulus.at("interval95"), json::array({4.1234e5 - 1.96 * 2.1e3, 4.1234e5 + 1.96 * 2.1e3}));
  EXPECT_EQ(root.at("identifiable").at("mass_damping.alpha").at("verdict"), "ratio_only");
  EXPECT_EQ(root.at("identifiable").at("elasticity.young_modulus").at("reason"), "gravity is known");
  EXPECT_EQ(root.at("state"), "converged");
  EXPECT_EQ(root.at("model_text"), results.model_text);
  EXPECT_EQ(root.at("mesh"), json({{"nodes", 12}, {"tetrahedra", 5}}));
  EXPECT_EQ(root.at("frames"), 57);
  EXPECT_EQ(root.at("skipped").size(), 3u);
  EXPECT_EQ(root.at("skipped")[0].at("time"), 1500000000.0 + 0.02 * 9);
  EXPECT_EQ(root.at("rms_error"), 3.1e-4);
  EXPECT_EQ(root.at("relative_error"), 0.021);
  EXPECT_EQ(root.at("nis").at("mean_per_dof"), 1.02);
  EXPECT_EQ(root.at("nis").at("p_value"), 0.4);
  EXPECT_EQ(root.at("seconds_per_frame").at("median"), 0.004);
  EXPECT_EQ(root.at("seconds_per_frame").at("p99"), 0.007);
}

TEST(ResultsJson, NumbersThatDoNotExistAreNull) {
  Results results;
  results.parameters = {{"a.b", "Pa", nan, std::numeric_limits<double>::infinity(), nan, 1.0}};
  results.model = "\xff broken utf-8";
  const json root = json::parse(results_json(results));
  EXPECT_TRUE(root.at("parameters").at("a.b").at("mean").is_null());
  EXPECT_TRUE(root.at("parameters").at("a.b").at("std").is_null());
  EXPECT_TRUE(root.at("parameters").at("a.b").at("interval95")[0].is_null());
  EXPECT_TRUE(root.at("rms_error").is_null());
  EXPECT_TRUE(root.at("seconds_per_frame").at("p99").is_null());
  EXPECT_EQ(root.at("frames"), 0);
}

TEST(ResultsJson, OnlyTheTimingsDependOnTheMachine) {
  Results first = example(30), second = example(30);
  for (double& seconds : second.frame_seconds) seconds *= 2.0;
  second.stage_seconds[0].second = 9.0;
  json a = json::parse(results_json(first)), b = json::parse(results_json(second));
  EXPECT_NE(a, b);
  a.erase("seconds_per_frame");
  b.erase("seconds_per_frame");
  EXPECT_EQ(a, b);
  EXPECT_EQ(estimates_csv(first), estimates_csv(second));
}

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows = {{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      if (quoted && i + 1 < text.size() && text[i + 1] == '"') {
        rows.back().back() += text[++i];
      } else {
        quoted = !quoted;
      }
    } else if (c == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(EstimatesCsv, OneRowAFrameWithUnits) {
  const Results results = example(60);
  const auto rows = parse_csv(estimates_csv(results));
  ASSERT_EQ(rows.size(), 61u);
  for (const auto& row : rows) ASSERT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(rows[0][0], "time [s]");
  EXPECT_EQ(rows[0][3], "elasticity.young_modulus.mean [Pa]");
  EXPECT_EQ(rows[0][8], "mass_damping.alpha.std [1/s]");
  ASSERT_GE(rows[0].size(), 2U);
  const std::size_t reason = rows[0].size() - 2;
  EXPECT_EQ(rows[0][reason], "reason");
  EXPECT_EQ(rows[0][reason + 1], "state_reason");
  EXPECT_EQ(std::stod(rows[5][0]), results.frames[4].time);  // exact, though it is a date
  EXPECT_EQ(std::stod(rows[5][3]), results.frames[4].parameters[0].mean);
  EXPECT_EQ(rows[5][8], "");  // NaN
  EXPECT_EQ(rows[10][1], "0");
  EXPECT_EQ(rows[10][3], "");
  EXPECT_EQ(rows[10][reason], "no contour: contrast, \"too low\" & <dark>");
}

/// Two triangles over three frames, one point tracked, one outline with its picture.
Showing example_showing() {
  Replay replay;
  replay.name = "<the> estimate";
  replay.time = {0.0, 0.5, 1.0};
  replay.rms = {1e-4, 2e-4, nan};
  ReplayTrack track{"vertex 2", "m", {"x", "y", "z"}, Eigen::MatrixXd(3, 3), Eigen::MatrixXd(3, 3)};
  track.measured << 0.0, 0.01, nan, 1.0, 1.0, 1.0, -0.002, 0.002, 0.001;
  track.predicted = track.measured;
  replay.tracks = {track};
  replay.surface.rest.resize(3, 4);
  replay.surface.rest << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  replay.surface.triangles.resize(3, 2);
  replay.surface.triangles << 0, 0, 1, 2, 2, 3;
  replay.surface.frames = {0, 2};
  replay.surface.displacement.assign(2, Eigen::Matrix3Xd::Constant(3, 4, 0.25));
  replay.surface.error.assign(2, Eigen::VectorXd::Constant(4, 2e-4));
  replay.surface.error[1][3] = nan;
  replay.surface.sigmas.assign(2, Eigen::VectorXd::Constant(4, 2.0));
  ReplayOutline outline{0, 0.5, 64, 48, Eigen::Matrix2Xd(2, 3), true, Eigen::Matrix4Xd(4, 1)};
  outline.measured << 1.0, 2.04, nan, 4.0, 5.0, 6.0;
  outline.predicted << 1.0, 2.0, 3.0, 4.0;
  replay.outlines = {outline};
  return {1500000000.0, {replay}, {{0, 1500000000.5, "jpeg"}}};
}

/// What the page's script reads.
json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  return json::parse(page.substr(from, page.find("</script>", from) - from));
}

/// The page without its libraries and licences, which are not ours to judge.
std::string own_part(const std::string& page) {
  return page.substr(0, page.find("id=\"made\""));
}

TEST(ReportHtml, IsOneSafePage) {
  const std::string page = report_html(example(60), example_showing());
  for (const std::string fragment : {"412.3 kPa",
                                     "95 %: 408.2 to 416.5 kPa",
                                     "converged",
                                     "only a ratio",
                                     "&lt;density&gt;",
                                     "0.310 mm",
                                     "noise 0.300 mm",
                                     "2.10 %",
                                     "57",
                                     "3 skipped",
                                     "&lt;b&gt;&amp;&quot;quoted&quot;&lt;/b&gt;",
                                     "contrast, &quot;too low&quot;",
                                     "reduced basis of 24 vectors",
                                     "estimate model.yaml",
                                     "Eigen 3.4.0",
                                     "prefers-color-scheme: dark",
                                     "id=\"scrub\"",
                                     "default-src 'none'",
                                     "three.js authors",
                                     "Leon Sorokin"}) {
    EXPECT_NE(page.find(fragment), std::string::npos) << fragment;
  }
  for (const std::string fragment : {"http:", "https:", "src=", "@import", "url(", "<b>&", "{{"}) {
    EXPECT_EQ(own_part(page).find(fragment), std::string::npos) << fragment;
  }
  EXPECT_EQ(page.find("<the>"), std::string::npos);
}

TEST(ReportHtml, CarriesTheNumbersOfResultsJson) {
  const Results results = example(60);
  const json data = data_of(report_html(results, example_showing()));
  EXPECT_EQ(data.at("results"), json::parse(results_json(results)));
  const json& course = data.at("course");
  EXPECT_EQ(course.at("time").size(), 57u);
  EXPECT_NEAR(course.at("time")[1].get<double>(), 0.02, 1e-6);
  EXPECT_EQ(course.at("parameters")[0].at("unit"), "kPa");
  EXPECT_EQ(course.at("parameters")[0].at("mean")[4], 1e-3 * results.frames[4].parameters[0].mean);
  EXPECT_TRUE(course.at("parameters")[1].at("mean")[0].is_number());
  EXPECT_EQ(course.at("skipped").size(), 3u);
}

TEST(ReportHtml, RoundsWhatMovesButKeepsIt) {
  const json replay = json::parse(showing_json(example_showing())).at("replays")[0];
  const json& x = replay.at("tracks")[0].at("components")[0].at("measured");
  EXPECT_DOUBLE_EQ(x.at("offset").get<double>(), 0.005);
  EXPECT_EQ(x.at("data"), "AIMAfQCA");  // -32000, 32000, nothing
  EXPECT_EQ(replay.at("surface").at("error").at("data"), "/v7+/v7+/v8=");
  EXPECT_EQ(replay.at("outlines")[0].at("measured"), json::array({10, 40, 20, 50}));
  const json picture = json::parse(showing_json(example_showing())).at("pictures")[0];
  EXPECT_EQ(picture.at("time"), 0.5);
  EXPECT_EQ(picture.at("jpeg"), "data:image/jpeg;base64,anBlZw==");
}

TEST(ReportHtml, SaysWhenThereIsNothing) {
  Results results;
  const std::string page = own_part(report_html(results, {}));
  EXPECT_NE(page.find("No frame could be used"), std::string::npos);
  EXPECT_EQ(page.find("data-chart"), std::string::npos);
  EXPECT_EQ(page.find("id=\"scrub\""), std::string::npos);
  results.state = EstimateState::model_invalid;
  EXPECT_NE(report_html(results, {}).find("do not trust"), std::string::npos);
}

TEST(ReportHtml, WarnsBeforeTheNumberAndPutsYoungsModulusFirst) {
  Results results = example(20);
  std::swap(results.parameters[0], results.parameters[1]);
  results.state = EstimateState::drifting;
  const std::string page = report_html(results, {});
  EXPECT_LT(page.find("may lack an effect"), page.find("412.3 kPa"));
  EXPECT_LT(page.find("412.3 kPa"), page.find("2.00 1/s"));
}

TEST(ReportHtml, LongRunsStaySmallAndKeepTheirPeaks) {
  Results results = example(100000);
  results.frames[54321].misfit_rms = 0.5;
  const std::string page = report_html(results, {});
  EXPECT_LT(page.size(), 1500000u);
  const json course = data_of(page).at("course");
  EXPECT_LE(course.at("time").size(), 1500u);
  double largest = 0.0;
  for (const json& value : course.at("misfit")) largest = std::max(largest, value.get<double>());
  EXPECT_EQ(largest, 500.0);
}

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

TEST(Interrupted, ResultsSaySo) {
  Results results = example(20);
  EXPECT_EQ(json::parse(results_json(results)).at("complete"), true);
  EXPECT_EQ(own_part(report_html(results, {})).find("interrupted"), std::string::npos);
  results.interrupted = "frame 21 of <30>";
  EXPECT_EQ(json::parse(results_json(results)).at("complete"), false);
  EXPECT_EQ(json::parse(results_json(results)).at("interrupted_during"), "frame 21 of <30>");
  const std::string page = report_html(results, {});
  EXPECT_LT(page.find("The work was interrupted during: frame 21 of &lt;30&gt;"), page.find("412.3 kPa"));
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

TEST(WriteResults, WritesThreeFilesIntoANewFolder) {
  const fs::path folder = fs::temp_directory_path() / "tissue_stiffness_report_test" / "deep";
  fs::remove_all(folder.parent_path());
  const Results results = example(20);
  write_results(results, example_showing(), folder.string());
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"results.json", results_json(results)},
                                   {"estimates.csv", estimates_csv(results)},
                                   {"report.html", report_html(results, example_showing())}}) {
    std::ifstream stream(folder / name, std::ios::binary);
    std::stringstream content;
    content << stream.rdbuf();
    EXPECT_EQ(content.str(), text) << name;
  }
  EXPECT_THROW(write_results(results, {}, (folder / "results.json").string()), InputError);
  EXPECT_THROW(write_text((folder / "missing" / "file").string(), "x"), InputError);
  fs::remove_all(folder.parent_path());
}

TEST(Text, NumbersForPeople) {
  EXPECT_EQ(rounded(412.34, 0.61), "412.34");
  EXPECT_EQ(rounded(412.34, 6.1), "412.3");
  EXPECT_EQ(rounded(41234.0, 610.0), "41230");
  EXPECT_EQ(rounded(3.0, nan), "3.000");
  EXPECT_EQ(short_number(nan, 3), "-");
  EXPECT_EQ(short_number(0.00012345, 3), "0.000123");
  EXPECT_EQ(short_number(1.5e9, 2), "1.5e+09");
  EXPECT_EQ(fixed_number(nan, 1), "-");
  EXPECT_EQ(fixed_number(-0.04, 1), "0.0");
  EXPECT_EQ(fixed_number(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed_number(1334.56, 1), "1334.6");
  EXPECT_EQ(exact_number(0.1), "0.1");
  EXPECT_EQ(exact_number(nan), "");
  EXPECT_EQ(shown_unit(30e3, "Pa").name, "kPa");
  EXPECT_EQ(shown_unit(3e-4, "m").name, "mm");
  EXPECT_EQ(shown_unit(3e-5, "m").name, "µm");
  EXPECT_EQ(shown_unit(5000.0, "m").name, "m");
  EXPECT_EQ(shown_unit(0.02, "1/s").name, "1/s");
  EXPECT_EQ(shown_unit(0.45, "-").name, "");
  EXPECT_EQ(parameter_title("elasticity#2.young_modulus"), "Young's modulus (elasticity#2)");
}

}  // namespace
}  // namespace tissue_stiffness
