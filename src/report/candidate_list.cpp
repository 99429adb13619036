#include "report/candidate_list.hpp"

#include <algorithm>
#include <cmath>

#include "report/course.hpp"
#include "report/effect_words.hpp"
#include "report/page.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

using Units = std::map<std::string, std::string>;

constexpr double kProbable = 0.01;  // what is less probable is in the table alone

/// A refit may even be worse than the given model.
std::string gain(double explained) {
  return explained > 5e-4 ? percentage(explained, 3) : "nothing";
}

/// Returns the components x, y and z of a vector of which `name` is the first; nothing for other parameters.
std::vector<double> vector_from(const std::string& name, const std::map<std::string, double>& parameters) {
  if (name.size() < 2 || name.compare(name.size() - 2, 2, "_x") != 0) return {};
  std::vector<double> out;
  for (const char axis : {'x', 'y', 'z'}) {
    const auto found = parameters.find(name.substr(0, name.size() - 1) + axis);
    if (found == parameters.end()) return {};
    out.push_back(found->second);
  }
  return out;
}

/// Returns "(-39.7, -11.5, 15.5) mm".
std::string shown_vector(const std::vector<double>& components, const std::string& unit) {
  double most = 0.0;
  for (const double x : components) most = std::max(most, std::abs(x));
  const ShownUnit shown = shown_unit(most, unit);
  std::string text;
  for (const double x : components) text += (text.empty() ? "(" : ", ") + short_number(shown.scale * x, 3);
  return text + ")" + (shown.name.empty() ? "" : " " + shown.name);
}

/// Returns "gamma = 1.52, tau = 194 ms": the effect's own parameters.
std::string parameter_words(const MissingEffect& c, const Units& units) {
  std::string text, vector;  // whose components are written already
  for (const auto& [name, value] : c.parameters) {
    if (name.rfind(c.effect + ".", 0) != 0) continue;
    if (!vector.empty() && name.rfind(vector, 0) == 0 && name.size() == vector.size() + 1) continue;
    const auto known = units.find(name);
    const std::string unit = known == units.end() ? "" : known->second;
    const std::vector<double> components = vector_from(name, c.parameters);
    vector = components.empty() ? "" : name.substr(0, name.size() - 1);
    std::string title = name.substr(c.effect.size() + 1);
    if (!components.empty()) title.resize(title.size() - 2);
    std::replace(title.begin(), title.end(), '_', ' ');
    text += (text.empty() ? "" : ", ") + title + " = " +
            (components.empty() ? with_unit(value, unit) : shown_vector(components, unit));
  }
  return text;
}

std::string confusable_words(const MissingEffect& c) {
  std::string text;
  for (const auto& other : c.confusable_with) {
    text += (text.empty() ? "" : ", ") + effect_title(other.effect) + " (" + short_number(other.cosine, 2) + ")";
  }
  return text;
}

std::string line(const std::string& name, double probability, const std::string& kind, const std::string& words) {
  const std::string width = short_number(std::clamp(100.0 * probability, 0.0, 100.0), 3);
  return "<li" + kind + "><h3>" + escape_html(name) + "</h3><div class=\"bar\"><i style=\"width:" + width +
         "%\"></i></div><p>" + escape_html(percentage(probability, 2) + words) + "</p></li>";
}

bool in_set(const MissingEffect& c, const Diagnosis& d) {
  return std::find(d.set.begin(), d.set.end(), c.effect) != d.set.end();
}

/// What the summary at the top says of the effect is not said again.
std::string line(const MissingEffect& c, const Diagnosis& d, const Units& units) {
  const bool told = d.best.effects == std::vector<std::string>{c.effect};
  std::vector<std::string> words;
  if (!told) words.push_back("explains " + gain(c.explained) + " of the squared error");
  if (!c.parameters.empty()) words.push_back(parameter_words(c, units));
  if (!c.confusable_with.empty()) words.push_back("confusable with " + confusable_words(c));
  std::string text;
  for (const std::string& word : words) text += (word.empty() ? "" : "; ") + word;
  return line(capitalised(effect_title(c.effect)), c.probability, in_set(c, d) ? " class=\"chosen\"" : "", text);
}

std::string row(const MissingEffect& c, const Units& units) {
  const auto cell = [](const std::string& text) { return "<td class=\"n\">" + escape_html(text) + "</td>"; };
  const bool refitted = std::isfinite(c.held_out_rms_after);
  return "<tr><td class=\"why\"><b>" + escape_html(effect_title(c.effect)) + "</b><br><small class=\"soft\">" +
         escape_html(effect_sign(c.effect)) + "</small></td>" +
         cell(refitted ? percentage(c.probability, 2) : "not refitted") + cell(test_statistic(c.z)) +
         cell(gain(c.explained)) + cell(millimetres(c.held_out_rms_after)) + cell(shown_moduli(c.parameters)) +
         "<td class=\"why\">" + escape_html(parameter_words(c, units)) + "</td><td>" + escape_html(confusable_words(c)) +
         "</td></tr>";
}

std::string table(const Diagnosis& d, const Units& units, bool open) {
  std::string rows;
  for (const MissingEffect& c : d.candidates) rows += row(c, units);
  return "<details" + std::string(open ? " open" : "") + "><summary>All " + std::to_string(d.candidates.size()) +
         " effects that were tried</summary><div class=\"scroll\"><table><tr><th>effect</th><th "
         "class=\"n\">probability</th><th class=\"n\">z</th><th class=\"n\">explains</th><th class=\"n\">held-out "
         "error</th><th class=\"n\">best fit of E</th><th>its parameters</th><th>confusable with (cosine)</th></tr>" +
         rows + "</table></div></details>";
}

}  // namespace

std::string candidate_list(const Diagnosis& d, const Units& units) {
  if (d.candidates.empty()) return "";
  std::string lines;
  for (const MissingEffect& c : d.candidates) {
    if (in_set(c, d) || c.probability >= kProbable) lines += line(c, d, units);
  }
  const bool open = lines.empty();
  if (d.adequate >= kProbable) lines += line("The model as given", d.adequate, "", "");
  if (d.none_of_these >= kProbable) lines += line("None of these", d.none_of_these, "", "");
  const std::string list =
      lines.empty() ? "<p>No effect has a probability of 1 %.</p>" : "<ol class=\"effects\">" + lines + "</ol>";
  return section("missing", "What could be missing, and how probable it is", list + table(d, units, open));
}

}  // namespace tissue_stiffness
