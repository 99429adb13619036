#include "report/page.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "report/assets.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

/// Inside a script element only '<' is dangerous.
std::string safe_json(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string fill(const std::string& page, const std::map<std::string, std::string>& values) {
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = page.find("{{"); at != std::string::npos; at = page.find("{{", from)) {
    const std::size_t end = page.find("}}", at);
    out += page.substr(from, at - from) + values.at(page.substr(at + 2, end - at - 2));
    from = end + 2;
  }
  return out + page.substr(from);
}

std::string licence(const std::string& name, const std::string& text) {
  return "<details><summary>" + name + "</summary><pre>" + escape_html(text) + "</pre></details>";
}

/// Returns buttons, one of which is selected.
std::string choice(const std::string& name, const std::string& legend,
                   const std::vector<std::pair<std::string, std::string>>& options) {
  std::string text = "<fieldset class=\"choice\" id=\"choose-" + name + "\"><legend>" + legend + "</legend>";
  for (std::size_t i = 0; i < options.size(); ++i) {
    text += "<label><input type=\"radio\" name=\"" + name + "\" value=\"" + options[i].first + "\"" +
            (i == 0 ? " checked" : "") + "><span>" + escape_html(options[i].second) + "</span></label>";
  }
  return text + "</fieldset>";
}

std::string model_choice(const std::vector<Replay>& replays) {
  std::vector<std::pair<std::string, std::string>> models;
  for (std::size_t i = 0; i < replays.size(); ++i) models.emplace_back(std::to_string(i), replays[i].name);
  return models.size() > 1 ? choice("model", "Model", models) : "";
}

/// Returns the clock with its scrubber. It stands below the picture that it moves, and never covers it.
std::string player_bar() {
  return "<div class=\"player\"><button type=\"button\" id=\"play\" aria-label=\"Play\">▶</button>"
         "<input type=\"range\" id=\"scrub\" min=\"0\" value=\"0\" step=\"any\" aria-label=\"Time\">"
         "<output id=\"clock\"></output><select id=\"speed\" aria-label=\"Speed\"></select></div>";
}

/// Returns the place of the surface in three dimensions, with its controls.
std::string surface_place(bool arrows) {
  return "<div data-plot=\"surface\"><div id=\"surface\"></div>" + player_bar() +
         "<div id=\"colour-bar\"></div><div class=\"controls\">" +
         choice("colour", "Misfit in", {{"error", "mm"}, {"sigmas", "sigma"}}) +
         choice("span", "of", {{"frame", "this frame"}, {"all", "all frames"}}) +
         "<label class=\"slider\" title=\"Displacement, magnified\">motion ×<output id=\"magnify-value\">1</output>"
         "<input type=\"range\" id=\"magnify\" min=\"0\" max=\"5\" step=\"1\" value=\"0\"></label>"
         "<label class=\"tick\"><input type=\"checkbox\" id=\"measured\" checked> measured points</label>"
         "<label class=\"tick\"><input type=\"checkbox\" id=\"glass\"> glass where nothing was measured</label>" +
         std::string(arrows ? "<label class=\"tick\"><input type=\"checkbox\" id=\"arrows\" checked> missing force "
                              "<output id=\"arrow-scale\"></output></label>"
                            : "") +
         "<label class=\"tick\"><input type=\"checkbox\" id=\"surroundings\" checked> axes, loads and supports</label>"
         "<label class=\"tick\"><input type=\"checkbox\" id=\"turn\"> turn</label>"
         "<button type=\"button\" id=\"view\">Reset view</button>"
         "<span id=\"surface-saves\"></span></div></div><p class=\"soft\" id=\"picked\"></p>";
}

}  // namespace

std::string interruption_notice(const std::string& interrupted) {
  if (interrupted.empty()) return "";
  return "<p><span class=\"badge warn\">incomplete</span> The work was interrupted during: " + escape_html(interrupted) +
         ". This page holds what was known by then.</p>";
}

std::string short_path(const std::string& file) {
  const std::filesystem::path path(file);
  return (path.parent_path().filename() / path.filename()).string();
}

std::vector<std::string> without_common_folders(const std::vector<std::string>& paths) {
  std::vector<std::string> out = paths;
  for (std::size_t end; (end = out.front().find('/')) != std::string::npos;) {
    const std::string folder = out.front().substr(0, end + 1);
    if (!std::all_of(out.begin(), out.end(),
                     [&](const std::string& path) { return path.compare(0, end + 1, folder) == 0; })) {
      break;
    }
    for (std::string& path : out) path.erase(0, end + 1);
  }
  return out;
}

std::string Page::html() const {
  return fill(report_assets.page, {{"title", escape_html(title)},
                                   {"heading", escape_html(heading)},
                                   {"subheading", escape_html(subheading)},
                                   {"uplot_style", report_assets.uplot_style},
                                   {"style", report_assets.style},
                                   {"body", body},
                                   {"data", safe_json(data)},
                                   {"uplot", report_assets.uplot},
                                   {"three", report_assets.three},
                                   {"script", report_assets.script}});
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  if (content.empty()) return "";
  const std::string head = title.empty() ? "" : "<h2>" + escape_html(title) + "</h2>";
  return "<section id=\"" + id + "\">" + head + content + "</section>\n";
}

std::string chart_place(const std::string& id) {
  return "<div class=\"chart\" data-chart=\"" + id + "\"></div>";
}

std::string player(const Showing& showing, bool arrows) {
  if (showing.replays.empty()) return "";
  std::set<int> cameras;
  for (const Picture& p : showing.pictures) cameras.insert(p.source);
  const std::string picture =
      std::string(cameras.size() > 1
                      ? "<div class=\"controls\"><label>Images of <select id=\"camera\"></select></label></div>"
                      : "") +
      "<div data-plot=\"picture\"><canvas id=\"picture\"></canvas><p class=\"key\"><i class=\"measured\"></i>measured "
      "<i class=\"predicted\"></i>predicted <span id=\"picture-saves\"></span></p></div>";
  const std::string motion =
      "<div class=\"controls\"><label>Show <select id=\"track\"></select></label> <label>along <select id=\"component\">"
      "</select></label></div><div class=\"grid\">" +
      chart_place("motion") + chart_place("force") + "</div>";
  return section(
      "replay", "Model against measurement",
      model_choice(showing.replays) + surface_place(arrows) + (showing.pictures.empty() ? "" : picture) + motion);
}

std::string file_details(const std::string& summary, const std::string& text, bool open) {
  if (text.empty()) return "";
  return "<details" + std::string(open ? " open" : "") + "><summary>" + escape_html(summary) + "</summary><pre>" +
         escape_html(text) + "</pre></details>";
}

std::string colophon(const std::string& command_line, const std::vector<std::pair<std::string, std::string>>& versions,
                     const std::string& remark) {
  std::string list;
  for (const auto& [name, version] : versions) list += (list.empty() ? "" : " · ") + name + " " + version;
  return section("made", "How to make this again",
                 "<pre>" + escape_html(command_line) + "</pre>" +
                     (remark.empty() ? "" : "<p>" + escape_html(remark) + "</p>") + "<p class=\"soft\">" +
                     escape_html(list) + "</p><p class=\"soft\">Two libraries are under the MIT licence:</p>" +
                     licence("uPlot", report_assets.uplot_licence) + licence("three.js", report_assets.three_licence));
}

}  // namespace tissue_stiffness
