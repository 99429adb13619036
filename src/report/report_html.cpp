#include <algorithm>
#include <cmath>

#include "report/course.hpp"
#include "report/input_table.hpp"
#include "report/map_table.hpp"
#include "report/page.hpp"
#include "report/text.hpp"
#include "report/write_results.hpp"

namespace tissue_stiffness {
namespace {

/// Words for a state, and their colour.
struct StateWords {
  std::string badge, colour, sentence;
};
StateWords words(EstimateState state) {
  switch (state) {
    case EstimateState::converged:
      return {"converged", "good", "The interval has settled, and the misfit passes its test."};
    case EstimateState::converging:
      return {"converging", "warn", "The estimate has not settled, or too little is known."};
    case EstimateState::doubtful:
      return {"doubtful", "warn", "The estimate has settled, but the misfit or an input does not pass: do not rely on it."};
    case EstimateState::stale:
      return {"stale", "warn", "Measurements or loads have stopped: the value is the last one."};
    case EstimateState::drifting:
      return {"drifting", "warn", "The estimate keeps moving by more than its interval: the model may lack an effect."};
    case EstimateState::model_invalid:
      return {"model invalid", "bad", "The model does not explain the measurement: do not trust the value."};
    case EstimateState::no_data:
      break;
  }
  return {"no data", "bad", "No frame could be used: the values below are the prior."};
}

std::string badge(const std::string& colour, const std::string& text) {
  return "<span class=\"badge " + colour + "\">" + escape_html(text) + "</span>";
}

std::string answer_line(const ParameterEstimate& p) {
  const ShownUnit unit = shown_unit(p.mean, p.unit);
  const ShownEstimate shown = shown_estimate(p, unit.scale);
  const std::string suffix = unit.name.empty() ? "" : " " + escape_html(unit.name);
  return "<p class=\"answer\"><span class=\"name\">" + escape_html(parameter_title(p.name)) + "</span><b>" + shown.mean +
         suffix + "</b> <span class=\"interval\">95 %: " + shown.lower + " to " + shown.upper + suffix + "</span></p>";
}

std::string identifiability_badge(const IdentifiabilityRecord& record) {
  if (record.verdict == "absolute") return badge("good", "determined");
  return badge(record.verdict == "none" ? "bad" : "warn", record.verdict == "none" ? "not determined" : "only a ratio");
}

/// Returns at most three parameters: Young's moduli, or without one the first parameters. The table has all of them.
std::vector<ParameterEstimate> headline(const std::vector<ParameterEstimate>& parameters) {
  std::vector<ParameterEstimate> shown;
  for (const ParameterEstimate& p : parameters) {
    if (is_young_modulus(p.name)) shown.push_back(p);
  }
  if (shown.empty()) shown = parameters;
  if (shown.size() > 3) shown.resize(3);
  return shown;
}

std::string answer(const Results& results) {
  const StateWords state = words(results.state);
  std::string text;
  for (const ParameterEstimate& p : headline(results.parameters)) {
    text += answer_line(p);
    const auto found = results.identifiable.find(p.name);
    if (found == results.identifiable.end()) continue;
    text += "<p>" + identifiability_badge(found->second) + " " + escape_html(found->second.reason) + "</p>";
  }
  if (results.parameters.empty()) text += "<p>The model has no unknown parameter.</p>";
  const std::string badge_line =
      "<p>" + badge(state.colour, state.badge) + " " + state.sentence +
      (results.state_reason.empty() ? "" : " Reason: " + escape_html(results.state_reason) + ".") + "</p>";
  return section("answer", "", interruption_notice(results.interrupted) + badge_line + text);
}

std::string fact(const std::string& name, const std::string& value, const std::string& remark) {
  return "<div><dt>" + name + "</dt><dd>" + escape_html(value) + "<small>" + escape_html(remark) + "</small></dd></div>";
}

std::string facts(const Results& r) {
  const std::string noise = std::isfinite(r.noise_rms) ? "noise " + millimetres(r.noise_rms) : "";
  return section("facts", "",
                 "<dl class=\"facts\">" + fact("Error of the model", millimetres(r.rms_error), noise) +
                     fact("Error / motion", percentage(r.relative_error, 3), "") +
                     fact("Squared innovation", short_number(r.nis_mean_per_dof, 3), "per row; 1 if noise explains it") +
                     fact("Frames used", std::to_string(r.used()), std::to_string(r.skipped()) + " skipped") +
                     fact("Time a frame", with_unit(r.frame_seconds_quantile(0.5), "s"),
                          "99 % within " + with_unit(r.frame_seconds_quantile(0.99), "s")) +
                     "</dl>");
}

std::string parameter_row(const ParameterEstimate& p, const Results& results) {
  const ShownUnit unit = shown_unit(p.mean, p.unit);
  const ShownEstimate shown = shown_estimate(p, unit.scale);
  const auto cell = [](const std::string& text) { return "<td class=\"n\">" + escape_html(text) + "</td>"; };
  std::string row = "<tr><td>" + escape_html(p.name) + "</td>" + cell(shown.mean) +
                    cell(short_number(unit.scale * p.std, 2)) + cell(shown.lower) + cell(shown.upper) + "<td>" +
                    escape_html(unit.name) + "</td><td class=\"why\">";
  const auto found = results.identifiable.find(p.name);
  if (found == results.identifiable.end()) return row + "</td></tr>";
  return row + identifiability_badge(found->second) + " <span class=\"soft\">" + escape_html(found->second.reason) +
         "</span></td></tr>";
}

std::string parameter_table(const Results& results) {
  if (results.parameters.empty()) return "";
  std::string rows;
  for (const ParameterEstimate& p : results.parameters) rows += parameter_row(p, results);
  return section(
      "parameters", "Parameters",
      "<div class=\"scroll\"><table class=\"stacked\"><tr><th>parameter</th><th class=\"n\">mean</th>"
      "<th class=\"n\">std</th><th class=\"n\">95 % from</th><th class=\"n\">to</th><th>unit</th><th>do the data "
      "determine "
      "it?</th></tr>" +
          rows + "</table></div>");
}

/// Returns the reasons why frames were skipped, each with its count and first time, the most frequent first.
std::string skipped_table(const Results& results) {
  struct Reason {
    std::string text;
    int count;
    double first;
  };
  std::vector<Reason> reasons;
  for (const FrameRecord& frame : results.frames) {
    if (frame.used) continue;
    const auto same = std::find_if(reasons.begin(), reasons.end(), [&](const Reason& r) { return r.text == frame.reason; });
    if (same == reasons.end()) {
      reasons.push_back({frame.reason, 1, frame.time - results.frames.front().time});
    } else {
      ++same->count;
    }
  }
  if (reasons.empty()) return "";
  std::stable_sort(reasons.begin(), reasons.end(), [](const Reason& a, const Reason& b) { return a.count > b.count; });
  std::string rows;
  for (const Reason& reason : reasons) {
    rows += "<tr><td>" + escape_html(reason.text) + "</td><td class=\"n\">" + std::to_string(reason.count) +
            "</td><td class=\"n\">" + short_number(reason.first, 3) + " s</td></tr>";
  }
  return section("skipped", "Skipped frames",
                 "<div class=\"scroll\"><table><tr><th>reason</th><th class=\"n\">frames</th>"
                 "<th class=\"n\">first at</th></tr>" +
                     rows + "</table></div>");
}

std::string timing_table(const Results& results) {
  if (results.stage_seconds.empty()) return "";
  double total = 0.0;
  for (const auto& stage : results.stage_seconds) total += stage.second;
  std::string rows;
  for (const auto& [name, seconds] : results.stage_seconds) {
    const std::string share = escape_html(percentage(seconds / total, 2));
    rows += "<tr><td>" + escape_html(name) + "</td><td class=\"n\">" + with_unit(seconds, "s") + "</td><td class=\"n\">" +
            share + "</td></tr>";
  }
  return section("timings", "Where the time went",
                 "<div class=\"scroll\"><table><tr><th>stage</th><th class=\"n\">whole "
                 "run</th>"
                 "<th class=\"n\">share</th></tr>" +
                     rows + "</table></div>");
}

/// Returns the headline's parameters against time. Other parameters can be unfolded.
std::string courses(const Results& results) {
  if (results.frames.empty() || results.used() == 0) return "";
  const std::vector<ParameterEstimate> first = headline(results.parameters);
  std::string charts, others;
  for (const ParameterEstimate& p : results.parameters) {
    const bool shown = std::any_of(first.begin(), first.end(), [&](const auto& other) { return other.name == p.name; });
    (shown ? charts : others) += chart_place("parameter:" + escape_html(p.name));
  }
  if (!others.empty()) others = "<details><summary>Other parameters</summary>" + others + "</details>";
  return section("course", "The estimate over time", charts + others);
}

std::string misfit(const Results& results) {
  if (results.frames.empty() || results.used() == 0) return "";
  return section(
      "fails", "When the model fails",
      chart_place("misfit") +
          "<p class=\"soft\">Errors well above the noise mean physics that the model lacks: <code>diagnose</code> "
          "says which.</p>");
}

std::string choices(const Results& results) {
  std::string text;
  for (const std::string& line : results.description) text += "<li>" + escape_html(line) + "</li>";
  return section("choices", "What the estimator chose", text.empty() ? "" : "<ul>" + text + "</ul>");
}

}  // namespace

std::string report_html(const Results& results, const Showing& showing) {
  Page page;
  page.title = short_path(results.model) + " - tissue stiffness";
  page.heading = "Tissue stiffness";
  page.subheading = short_path(results.model) + " · " + short_path(results.recording);
  page.body = answer(results) + facts(results) + recordings_table(results.recordings) + courses(results) + player(showing) +
              misfit(results) + parameter_table(results) + input_section(results) +
              (results.map ? map_table(*results.map) : "") + skipped_table(results) + choices(results) +
              section("model", "", file_details("Model file", results.model_text, true)) + timing_table(results) +
              colophon(results.command_line, results.versions);
  page.data = "{\"results\":" + results_json(results) + ",\"course\":" + course_json(results, showing.first_stamp) +
              ",\"showing\":" + showing_json(showing) + "}";
  return page.html();
}

}  // namespace tissue_stiffness
