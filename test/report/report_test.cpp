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

TEST(ReportHtml, ShowsAnInputInOneUnit) {
  Results results = example(20);
  results.inputs = {{"/camera", "pose offset", "m", 3e-4, 1.54e-5, 2.8e-4, 2e-4},
                    {"/tool", "bias", "N", 0.0, 0.0, 0.0, 0.02}};
  const std::string page = report_html(results, {});
  for (const std::string cells : {"pose offset</td><td class=\"n\">0.300 mm</td><td class=\"n\">0.0154 mm</td><td "
                                  "class=\"n\">0.280 mm</td><td class=\"n\">&lt; 0.1 %</td>",
                                  "<td class=\"n\">0 N</td><td class=\"n\">2.0 %</td>", "The interval counts 2 errors"}) {
    EXPECT_NE(page.find(cells), std::string::npos) << cells;
  }
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

}  // namespace
}  // namespace tissue_stiffness
