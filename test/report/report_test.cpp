#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tissue_stiffness/report/chart.hpp"
#include "tissue_stiffness/report/frame_charts.hpp"
#include "tissue_stiffness/report/text.hpp"
#include "tissue_stiffness/report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ParameterEstimate young(double mean, double std) {
  return {"elasticity.young_modulus", "Pa", mean, std, mean - 1.96 * std, mean + 1.96 * std};
}

/// A run that settles on 412 kPa, with a few frames lost.
Results example(int frames) {
  Results results;
  results.model = "model.yaml";
  results.recording = "recording.bag";
  results.state = EstimateState::converged;
  for (int i = 0; i < frames; ++i) {
    FrameRecord frame;
    frame.time = 1500000000.0 + 0.02 * i;
    if (i % 17 == 9) {
      frame.used = false;
      frame.reason = i % 2 ? "no contour: contrast, \"too low\" & <dark>" : "late";
    } else {
      const double std = 3e5 / (1.0 + 0.5 * i);
      frame.misfit_rms = 3e-4 * (1.0 + 0.2 * std::sin(i) + 3.0 * std::exp(-0.3 * i));
      frame.misfit_sigma = frame.misfit_rms / 3e-4;
      frame.nis = 100.0 + 10.0 * std::sin(2.0 * i);
      frame.dof = 100;
      frame.outliers = i % 3;
      results.frame_seconds.push_back(0.001 * (1 + i % 7));
      frame.parameters = {young(4.12e5 + 2e5 * std::exp(-0.2 * i), std), {"mass_damping.alpha", "1/s", 2.0, nan, 1.0, 3.0}};
    }
    frame.state = i < 20 ? EstimateState::converging : EstimateState::converged;
    results.frames.push_back(frame);
  }
  results.parameters = {young(4.1234e5, 2.1e3), {"mass_damping.alpha", "1/s", 2.0, 0.5, 1.2, 3.1}};
  results.identifiable = {{"elasticity.young_modulus", {"absolute", "gravity is known"}},
                          {"mass_damping.alpha", {"ratio_only", "only its product with <density> matters"}}};
  results.rms_error = 3.1e-4;
  results.noise_rms = 3e-4;
  results.relative_error = 0.021;
  results.nis_mean_per_dof = 1.02;
  results.nis_p_value = 0.4;
  results.stage_seconds = {{"predict", 1.5}, {"observe", 0.3}, {"update", 0.02}};
  results.description = {"reduced basis of 24 vectors", "step 0.005 s"};
  results.model_text = "mesh: {file: mesh.vtk}  # <b>&\"quoted\"</b>\neffects:\n- inertia: {density: 1060}\n";
  results.command_line = "estimate model.yaml recording.bag --output out";
  results.versions = {{"tissue_stiffness", "0.1.0"}, {"Eigen", "3.4.0"}};
  return results;
}

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
  EXPECT_EQ(rows[0].back(), "reason");
  EXPECT_EQ(std::stod(rows[5][0]), results.frames[4].time);  // exact, though it is a date
  EXPECT_EQ(std::stod(rows[5][3]), results.frames[4].parameters[0].mean);
  EXPECT_EQ(rows[5][8], "");  // NaN
  EXPECT_EQ(rows[10][1], "0");
  EXPECT_EQ(rows[10][3], "");
  EXPECT_EQ(rows[10].back(), "no contour: contrast, \"too low\" & <dark>");
}

TEST(ReportHtml, IsOneSafePage) {
  const std::string page = report_html(example(60));
  for (const std::string fragment :
       {"412.3 kPa", "95 %: 408.2 to 416.5 kPa", "converged", "only a ratio", "&lt;density&gt;", "0.310 mm",
        "noise 0.300 mm", "2.10 %", "57", "3 skipped", "&lt;b&gt;&amp;&quot;quoted&quot;&lt;/b&gt;",
        "contrast, &quot;too low&quot;", "reduced basis of 24 vectors", "estimate model.yaml", "Eigen 3.4.0",
        "prefers-color-scheme: dark", "<svg"}) {
    EXPECT_NE(page.find(fragment), std::string::npos) << fragment;
  }
  for (const std::string fragment : {"http:", "https:", "<script", "src=", "@import", "url(", "<b>&", "nan", "inf\""}) {
    EXPECT_EQ(page.find(fragment), std::string::npos) << fragment;
  }
}

TEST(ReportHtml, SaysWhenThereIsNothing) {
  Results results;
  EXPECT_NE(report_html(results).find("No frame could be used"), std::string::npos);
  EXPECT_EQ(frame_charts(results), "");
  results.state = EstimateState::model_invalid;
  EXPECT_NE(report_html(results).find("do not trust"), std::string::npos);
}

TEST(ReportHtml, WarnsBeforeTheNumberAndPutsYoungsModulusFirst) {
  Results results = example(20);
  std::swap(results.parameters[0], results.parameters[1]);
  results.state = EstimateState::drifting;
  const std::string page = report_html(results);
  EXPECT_LT(page.find("may lack an effect"), page.find("412.3 kPa"));
  EXPECT_LT(page.find("412.3 kPa"), page.find("2.00 1/s"));
}

TEST(ReportHtml, LongRunsStaySmallAndKeepTheirPeaks) {
  Results results = example(100000);
  results.frames[54321].misfit_rms = 0.5;
  const std::string page = report_html(results);
  EXPECT_LT(page.size(), 600000u);
  EXPECT_NE(page.find("[m]"), std::string::npos);  // the axis follows the one peak of 0.5 m
}

TEST(WriteResults, WritesThreeFilesIntoANewFolder) {
  const fs::path folder = fs::temp_directory_path() / "tissue_stiffness_report_test" / "deep";
  fs::remove_all(folder.parent_path());
  const Results results = example(20);
  write_results(results, folder.string());
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"results.json", results_json(results)},
                                   {"estimates.csv", estimates_csv(results)},
                                   {"report.html", report_html(results)}}) {
    std::ifstream stream(folder / name, std::ios::binary);
    std::stringstream content;
    content << stream.rdbuf();
    EXPECT_EQ(content.str(), text) << name;
  }
  EXPECT_THROW(write_results(results, (folder / "results.json").string()), InputError);
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

TEST(Chart, TicksAreRoundNumbersInside) {
  EXPECT_EQ(linear_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(linear_ticks(-1.0, 1.0, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(log_ticks(1.5, 30.0), (std::vector<double>{2, 5, 10, 20}));
  EXPECT_EQ(log_ticks(0.5, 2000.0), (std::vector<double>{1, 10, 100, 1000}));
}

TEST(Chart, GapsBreakTheLineAndOneFrameIsEnough) {
  Chart chart;
  chart.time = {0, 1, 2, 3};
  chart.line = {1, 2, nan, 4};
  const std::string html = chart.html();
  const std::string path = html.substr(html.find("class=\"line\""));
  EXPECT_EQ(std::count(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(path.find("/>")), 'M'), 2);
  chart.time = {5};
  chart.line = {7};
  EXPECT_EQ(chart.html().find("nan"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
