#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "report/comparison.hpp"
#include "report/course.hpp"
#include "report/difference_table.hpp"
#include "report/page.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

constexpr std::size_t kMostPoints = 1500;

const ParameterEstimate* parameter(const ComparedRun& run, const std::string& name) {
  const auto found = std::find_if(run.parameters.begin(), run.parameters.end(),
                                  [&](const ParameterEstimate& p) { return p.name == name; });
  return found == run.parameters.end() ? nullptr : &*found;
}

/// Returns the names of all parameters, Young's moduli first.
std::vector<std::string> names(const std::vector<ComparedRun>& runs) {
  std::set<std::string> all;
  for (const ComparedRun& run : runs) {
    for (const ParameterEstimate& p : run.parameters) all.insert(p.name);
  }
  std::vector<std::string> out(all.begin(), all.end());
  std::stable_partition(out.begin(), out.end(), [](const std::string& name) { return is_young_modulus(name); });
  return out;
}

/// Returns the unit with the prefix that suits the largest of all means.
ShownUnit common_unit(const std::vector<ComparedRun>& runs, const std::string& name) {
  double most = 0.0;
  std::string unit;
  for (const ComparedRun& run : runs) {
    const ParameterEstimate* p = parameter(run, name);
    if (p == nullptr) continue;
    unit = p->unit;
    most = std::isfinite(p->mean) ? std::max(most, std::abs(p->mean)) : most;
  }
  return shown_unit(most, unit);
}

std::string cell(const std::string& text, const std::string& kind = "") {
  return "<td" + (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + escape_html(text) + "</td>";
}

/// A name may be long: it wraps, and columns stay in view.
std::string name_cell(const std::string& name) {
  return "<td class=\"run\"><span title=\"" + escape_html(name) + "\">" + escape_html(name) + "</span></td>";
}

std::string file_cell(const std::string& file) {
  const std::string path = escape_html(short_path(file));
  const std::size_t slash = path.rfind('/') + 1;  // 0 without one
  return "<td class=\"file\">" + path.substr(0, slash) + "<wbr>" + path.substr(slash) + "</td>";
}

std::string badge(const std::string& state) {
  const std::string colour = state == "converged"                             ? "good"
                             : state == "model_invalid" || state == "no_data" ? "bad"
                                                                              : "warn";
  std::string text = state;
  std::replace(text.begin(), text.end(), '_', ' ');
  return "<span class=\"badge " + colour + "\">" + escape_html(text) + "</span>";
}

std::string overview(const std::vector<ComparedRun>& runs) {
  std::string rows;
  for (const ComparedRun& run : runs) {
    rows += "<tr>" + name_cell(run.name) + file_cell(run.model) + file_cell(run.recording) + "<td>" + badge(run.state) +
            " <span class=\"soft\">" + escape_html(run.state_reason) + "</span></td>" +
            cell(millimetres(run.rms_error), "n") + cell(millimetres(run.noise_rms), "n") +
            cell(short_number(run.rms_error / run.noise_rms, 3), "n") + cell(std::to_string(run.frames), "n") + "</tr>";
  }
  return section("runs", "Runs",
                 "<div class=\"scroll\"><table "
                 "class=\"stacked\"><thead><tr><th>run</th><th>model</th><th>recording</th><th>state</th><th "
                 "class=\"n\">error</th><th class=\"n\">noise</th><th class=\"n\">error / noise</th><th "
                 "class=\"n\">frames</th></tr></thead><tbody>" +
                     rows + "</tbody></table></div>");
}

std::string parameter_rows(const std::vector<ComparedRun>& runs, const std::string& name) {
  const ShownUnit unit = common_unit(runs, name);
  const std::string suffix = unit.name.empty() ? "" : " " + unit.name;
  std::string rows;
  for (const ComparedRun& run : runs) {
    const ParameterEstimate* p = parameter(run, name);
    const ShownEstimate shown = p == nullptr ? ShownEstimate{} : shown_estimate(*p, unit.scale);
    rows += "<tr>" + name_cell(run.name) +
            (p == nullptr ? cell("not in this model", "n") + cell("")
                          : cell(shown.mean + suffix, "n") + cell(shown.lower + " to " + shown.upper + suffix, "n")) +
            "</tr>";
  }
  return "<h3>" + escape_html(parameter_title(name)) +
         "</h3><div class=\"grid\"><div class=\"scroll\"><table class=\"stacked\"><thead><tr><th>run</th><th "
         "class=\"n\">estimate</th><th class=\"n\">95 %</th></tr></thead><tbody>" +
         rows + "</tbody></table></div>" + chart_place("intervals:" + escape_html(name)) + "</div>" +
         chart_place("compare:" + escape_html(name));
}

std::string parameters(const std::vector<ComparedRun>& runs) {
  std::string content;
  for (const std::string& name : names(runs)) content += parameter_rows(runs, name);
  return section("parameters", "Parameters", content);
}

std::string models(const std::vector<ComparedRun>& runs) {
  const ComparedRun& first = runs.front();
  std::string content, files = file_details("Model of " + first.name, first.model_text, false);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    content +=
        difference_table({"model of " + first.name, first.model_text}, {"model of " + runs[i].name, runs[i].model_text});
    files += file_details("Model of " + runs[i].name, runs[i].model_text, false);
  }
  return section("model", "How the models differ", content + files);
}

/// Returns numbers times a scale, thinned to every `step`-th; null where there is none.
json list(const std::vector<double>& values, double scale, std::size_t step) {
  json out = json::array();
  for (std::size_t k = 0; k < values.size(); k += step)
    out.push_back(std::isfinite(values[k]) ? json(scale * values[k]) : json(nullptr));
  return out;
}

/// Returns the final estimate in the displayed unit, as [mean, lower, upper].
json final_json(const ParameterEstimate& p, double scale) {
  return list({p.mean, p.lower95, p.upper95}, scale, 1);
}

json run_json(const std::vector<ComparedRun>& runs, const ComparedRun& run) {
  const std::size_t step = 1 + run.time.size() / kMostPoints;
  json all = json::object();
  for (std::size_t i = 0; i < run.parameters.size(); ++i) {
    const std::string& name = run.parameters[i].name;
    const ShownUnit unit = common_unit(runs, name);
    all[name] = {{"final", final_json(run.parameters[i], unit.scale)},
                 {"mean", list(run.mean[i], unit.scale, step)},
                 {"lower", list(run.lower[i], unit.scale, step)},
                 {"upper", list(run.upper[i], unit.scale, step)}};
  }
  return {{"name", run.name},
          {"time", list(run.time, 1.0, step)},
          {"misfit", list(run.misfit, 1e3, step)},
          {"parameters", all}};
}

std::string data(const std::vector<ComparedRun>& runs) {
  json all = json::array(), titles = json::object();
  for (const ComparedRun& run : runs) all.push_back(run_json(runs, run));
  for (const std::string& name : names(runs)) {
    const std::string unit = common_unit(runs, name).name;
    titles[name] = parameter_title(name) + (unit.empty() ? "" : " [" + unit + "]");
  }
  return json({{"compare", {{"runs", all}, {"titles", titles}}}, {"showing", {{"replays", json::array()}}}})
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Names each run by its folder, without the folders that all runs lie in.
std::vector<ComparedRun> with_short_names(std::vector<ComparedRun> runs) {
  std::vector<std::string> names;
  for (const ComparedRun& run : runs) names.push_back(run.name);
  names = without_common_folders(names);
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].name = names[i];
  return runs;
}

}  // namespace

std::string comparison_html(const std::vector<ComparedRun>& compared, const std::string& command_line,
                            const std::vector<std::pair<std::string, std::string>>& versions) {
  const std::vector<ComparedRun> runs = with_short_names(compared);
  Page page;
  page.title = "Comparison - tissue stiffness";
  page.heading = "Comparison";
  page.subheading = std::to_string(runs.size()) + " runs";
  page.body = overview(runs) + parameters(runs) +
              section("fails", "Error over time",
                      chart_place("compare-misfit") +
                          "<p class=\"soft\">The error of each frame at the estimate of that moment.</p>") +
              models(runs) + colophon(command_line, versions);
  page.data = data(runs);
  return page.html();
}

}  // namespace tissue_stiffness
