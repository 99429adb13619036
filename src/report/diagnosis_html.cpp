#include <algorithm>
#include <cmath>
#include <map>

#include "report/course.hpp"
#include "report/effect_words.hpp"
#include "report/page.hpp"
#include "report/text.hpp"
#include "report/write_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kShownEffects = 6;  // in full; the others in a table to fold out

std::string percent(double share) {
  return short_number(100.0 * share, 3) + " %";
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string paragraph(const std::string& text) {
  return text.empty() ? "" : "<p>" + escape_html(text) + "</p>";
}

std::string verdict_badge(Verdict verdict) {
  const bool open = verdict == Verdict::missing || verdict == Verdict::unfinished;
  const std::string colour = verdict == Verdict::adequate ? "good" : open ? "warn" : "bad";
  const std::string text = verdict == Verdict::missing      ? "an effect is missing"
                           : verdict == Verdict::numerics   ? "adequate but for the numerics"
                           : verdict == Verdict::adequate   ? "model adequate"
                           : verdict == Verdict::unfinished ? "no verdict yet"
                                                            : "error not explained";
  return "<span class=\"badge " + colour + "\">" + text + "</span>";
}

/// Returns the Young's moduli among parameters: "19.0 kPa".
std::string moduli(const std::map<std::string, double>& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    if (!is_young_modulus(name)) continue;
    const ShownUnit unit = shown_unit(value, "Pa");
    text += (text.empty() ? "" : ", ") + short_number(unit.scale * value, 4) + " " + unit.name;
  }
  return text;
}

/// Returns a Young's modulus with its interval as the answer.
std::string modulus_answer(const std::string& name, const Diagnosis& d) {
  std::string text = moduli(d.steps.back().parameters), interval, comma;
  for (const ParameterEstimate& p : d.estimate.parameters) {
    if (!is_young_modulus(p.name)) continue;
    const ShownUnit unit = shown_unit(p.mean, p.unit);
    const double half_width = 0.5 * unit.scale * (p.upper95 - p.lower95);
    if (comma.empty()) text.clear();
    text += comma + rounded(unit.scale * p.mean, half_width) + " " + unit.name;
    interval += (comma.empty() ? "95 %: " : comma) + rounded(unit.scale * p.lower95, half_width) + " to " +
                rounded(unit.scale * p.upper95, half_width) + " " + unit.name;
    comma = ", ";
  }
  if (text.empty()) return "";
  if (!interval.empty() && d.estimate.state == EstimateState::no_data) interval += ", of the fit itself";
  const std::string bias = d.final_verdict == Verdict::adequate ? ""
                           : d.final_verdict == Verdict::unfinished
                               ? "not known yet whether something is missing that biases it"
                               : "biased by what is missing";
  if (!bias.empty()) interval += (interval.empty() ? "" : "; ") + bias;
  return "<p class=\"answer\"><span class=\"name\">" + escape_html(name) + "</span><b>" + escape_html(text) +
         "</b> <span class=\"interval\">" + escape_html(interval) + "</span></p>";
}

std::string answer(const Diagnosis& d) {
  std::string text = interruption_notice(d.interrupted) + "<p>" + verdict_badge(d.verdict) + "</p><p class=\"verdict\">" +
                     escape_html(diagnosis_sentence(d)) + "</p>";
  if (d.steps.empty()) return section("answer", "", text);
  const DiagnosisStep &first = d.steps.front(), &last = d.steps.back();
  if (d.steps.size() > 1) {
    text += modulus_answer("Young's modulus, with " + effect_list(d.final_effects), d) +
            paragraph("The best fit of the given model says " + moduli(first.parameters) + ". With " +
                      effect_list(d.final_effects) + " the held-out error falls from " + millimetres(first.held_out_rms) +
                      " to " + millimetres(last.held_out_rms) + "; the noise is " + millimetres(last.noise_floor) +
                      ". Then: " + to_string(d.final_verdict) + ".");
  } else {
    text += modulus_answer("Young's modulus of the given model", d);
  }
  return section("answer", "", text);
}

std::string part(const std::string& name, double metres, double sigmas) {
  return "<div><dt>" + name + "</dt><dd>" + millimetres(metres) + "<small>" + escape_html(short_number(sigmas, 3)) +
         " sigma</small></dd></div>";
}

std::string force_paragraph(const MissingForce& force) {
  if (force.time.empty()) return "";
  return "<p><b>What would make up for it:</b> at " + escape_html(moduli(force.parameters)) + ", a force of " +
         escape_html(force.words) + ". It explains " + percent(force.explained) +
         " of the squared error there. The arrows above show it.</p>";
}

std::string rounded_millimetres(double metres) {
  return std::to_string(std::lround(1e3 * metres));
}

std::string belief_rows(const BeliefMap& b) {
  std::string rows;
  for (Eigen::Index p = 0; p < b.centres.cols(); ++p) {
    rows += "<tr><td>(" + rounded_millimetres(b.centres(0, p)) + ", " + rounded_millimetres(b.centres(1, p)) + ", " +
            rounded_millimetres(b.centres(2, p)) + ")</td>";
    for (Eigen::Index third = 0; third < 3; ++third) {
      const double valid = b.probability(p, third);
      rows += "<td class=\"n\" style=\"background:rgba(213,94,0," + short_number(0.6 * (1.0 - valid), 2) + ")\">" +
              (valid < 1e-3 ? "&lt; 0.1" : short_number(100.0 * valid, 2)) + " %</td>";
    }
    rows += "</tr>";
  }
  return rows;
}

std::string belief_table(const std::string& model, const BeliefMap& b) {
  if (b.nodes.empty()) return "";
  return "<table><caption>" + escape_html(model) +
         "</caption><tr><th>part around [mm]</th><th class=\"n\">first third</th><th class=\"n\">second</th><th "
         "class=\"n\">last</th></tr>" +
         belief_rows(b) + "</table>";
}

std::string valid(const Diagnosis& d) {
  if (d.valid_given.nodes.empty()) return "";
  const std::string last =
      d.final_effects.empty() ? "" : belief_table("With " + effect_list(d.final_effects), d.valid_final);
  return section("valid", "Where and when the model is valid",
                 paragraph("The probability that what the model leaves on a part of the surface, in a third of the "
                           "recording, is noise or the error of the mesh.") +
                     "<div class=\"scroll grid\">" + belief_table("The given model", d.valid_given) + last + "</div>");
}

std::string fails(const Diagnosis& d) {
  if (d.steps.empty()) return "";
  const ErrorParts &m = d.metres, &s = d.sigmas;
  return section("fails", "Where and when the given model fails",
                 "<dl class=\"facts\">" + part("Error, rms", m.total, s.total) + part("of it noise", m.noise, s.noise) +
                     part("beyond noise", m.structured, s.structured) + part("of the mesh", m.numerical, s.numerical) +
                     "</dl><p><b>Where:</b> " + escape_html(d.where) + ".</p><p><b>When:</b> " + escape_html(d.when) +
                     ".</p>" + force_paragraph(d.force) + chart_place("residual-time") + "<div class=\"grid\">" +
                     chart_place("residual-node") + chart_place("residual-amplitude") + chart_place("residual-frequency") +
                     chart_place("residual-phase") + "</div>");
}

/// A refit may even be worse than the given model.
std::string gain(double explained) {
  return explained > 5e-4 ? percent(explained) : "nothing";
}

/// Returns "probability 94 %, leaves z = 1.2".
std::string belief(const MissingEffect& c) {
  return "probability " + short_number(100.0 * c.probability, 2) + " %, leaves z = " + short_number(c.z, 2);
}

/// Returns "The motion dies away faster ... Adding viscous damping would remove 91 % of the squared error ...".
std::string story(const MissingEffect& c) {
  const bool refitted = std::isfinite(c.held_out_rms_after);
  std::string text = capital(effect_sign(c.effect)) + ". Adding " + effect_title(c.effect) + " would remove " +
                     gain(c.explained) + " of the squared error" +
                     (refitted ? "" : ", to first order; it was not refitted");
  if (refitted) {
    text += "; on frames that the fit has not seen, the error goes from " + millimetres(c.held_out_rms_before) + " to " +
            millimetres(c.held_out_rms_after);
  }
  text += ".";
  std::vector<std::string> alike;
  for (const auto& other : c.confusable_with) alike.push_back(other.effect);
  if (!alike.empty()) text += " In this recording it is confusable with " + effect_list(alike) + ".";
  return text;
}

std::string parameter_words(const MissingEffect& c, const std::map<std::string, std::string>& units) {
  std::string text;
  for (const auto& [name, value] : c.parameters) {
    const auto known = units.find(name);
    const ShownUnit unit = known == units.end() ? ShownUnit{1.0, ""} : shown_unit(value, known->second);
    text += (text.empty() ? "" : ", ") + parameter_title(name) + " = " + short_number(unit.scale * value, 3) +
            (unit.name.empty() ? "" : " " + unit.name);
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

std::string effect_card(const MissingEffect& c, bool in_set, const std::map<std::string, std::string>& units) {
  const std::string width = short_number(std::clamp(100.0 * c.explained, 0.0, 100.0), 3);
  return "<li" + std::string(in_set ? " class=\"chosen\"" : "") + "><h3>" + escape_html(capital(effect_title(c.effect))) +
         "<span>" + (c.explained > 5e-4 ? percent(c.explained) : "0 %") +
         "</span></h3><div class=\"bar\"><i style=\"width:" + width + "%\"></i></div>" + paragraph(story(c)) +
         "<p class=\"soft\">" + belief(c) + " · size " + short_number(c.size, 2) + " sigma · " +
         escape_html(parameter_words(c, units)) + "</p></li>";
}

std::string effect_row(const MissingEffect& c) {
  const auto cell = [](const std::string& text) { return "<td class=\"n\">" + escape_html(text) + "</td>"; };
  return "<tr><td>" + escape_html(effect_title(c.effect)) + "</td>" + cell(percent(c.explained)) +
         cell(millimetres(c.held_out_rms_after)) + cell(short_number(100.0 * c.probability, 2) + " %") +
         cell(short_number(c.z, 2)) + "<td>" + escape_html(confusable_words(c)) + "</td></tr>";
}

std::string ranking(const Diagnosis& d, const std::map<std::string, std::string>& units) {
  std::string cards, rows;
  for (std::size_t i = 0; i < d.candidates.size(); ++i) {
    const MissingEffect& c = d.candidates[i];
    const bool in_set = std::find(d.set.begin(), d.set.end(), c.effect) != d.set.end();
    if (i < kShownEffects) cards += effect_card(c, in_set, units);
    rows += effect_row(c);
  }
  if (cards.empty()) return "";
  std::string apart;
  if (!d.next_experiment.empty())
    apart = "<p class=\"next\"><b>To tell them apart:</b> " + escape_html(effect_title(d.next_experiment)) + ".</p>";
  return section(
      "missing", "What could be missing",
      "<ol class=\"effects\">" + cards + "</ol>" + apart + "<details><summary>All " + std::to_string(d.candidates.size()) +
          " effects that were tried</summary><div class=\"scroll\"><table><tr><th>effect</th><th "
          "class=\"n\">explains</th><th class=\"n\">held-out error after</th><th class=\"n\">probability</th><th "
          "class=\"n\">z</th><th>confusable with (cosine)</th></tr>" +
          rows + "</table></div></details>");
}

/// Says why the table's modulus is not the answer's.
std::string fit_remark(const Diagnosis& d) {
  if (d.estimate.parameters.empty()) return "";
  return "<p class=\"soft\">The moduli of this table are best fits to the whole recording, which compare the models. "
         "Young's "
         "modulus at the top is the estimate from frame to frame, with the errors of mesh and inputs: use that one.</p>";
}

std::string staircase(const Diagnosis& d) {
  if (d.steps.empty()) return "";
  std::string rows;
  std::size_t known = 0;
  for (const DiagnosisStep& step : d.steps) {
    const std::vector<std::string> added(step.effects.begin() + static_cast<std::ptrdiff_t>(known), step.effects.end());
    known = step.effects.size();
    const std::string name = added.empty() ? "as given" : "+ " + effect_list(added);
    rows += "<tr><td>" + escape_html(name) + "</td><td class=\"n\">" + millimetres(step.held_out_rms) +
            "</td><td class=\"n\">" + millimetres(step.train_rms) + "</td><td class=\"n\">" +
            millimetres(step.noise_floor) + "</td><td class=\"n\">" + escape_html(moduli(step.parameters)) +
            "</td><td class=\"n\">" + (step.effects.empty() ? "" : short_number(step.log_bayes_factor, 3)) + "</td></tr>";
  }
  return section("staircase", "The error, step by step",
                 chart_place("steps") +
                     "<div class=\"scroll\"><table><thead><tr><th>model</th><th class=\"n\">held-out "
                     "error</th><th class=\"n\">fitted frames</th><th class=\"n\">noise</th><th class=\"n\">Young's "
                     "modulus of the fit</th><th class=\"n\" title=\"log evidence that the last effect gains\">log Bayes "
                     "factor</th></tr></thead>" +
                     rows + "</table></div>" + fit_remark(d));
}

/// Says what the proposed model has beyond the given one.
std::string change_list(const Diagnosis& d) {
  std::string items;
  for (const std::string& entry : d.entries) items += "<li><code>" + escape_html(entry) + "</code></li>";
  return items.empty() ? "" : "<p><b>The proposed model has in addition:</b></p><ul>" + items + "</ul>";
}

}  // namespace

std::string diagnosis_html(const Diagnosis& d, const DiagnosisTexts& texts, const Showing& showing) {
  const bool proposed = !d.final_effects.empty();
  Page page;
  page.title = short_path(texts.model) + " - diagnosis";
  page.heading = "What does the model miss?";
  page.subheading = short_path(texts.model) + " · " + short_path(texts.recording);
  page.body =
      answer(d) + player(showing, !d.force.time.empty()) + fails(d) + valid(d) + ranking(d, texts.units) + staircase(d) +
      section(
          "model", "",
          change_list(d) + file_details("The given model", texts.model_text, "", !proposed) +
              (proposed ? file_details("The proposed model: model_next.yaml", texts.next_model_text, texts.model_text, true)
                        : "")) +
      section("timings", "", "<p>The diagnosis took " + escape_html(short_number(d.seconds, 3)) + " s.</p>") +
      colophon(texts.command_line, texts.versions);
  page.data = "{\"diagnosis\":" + diagnosis_json(d) + ",\"arrows\":" + arrows_json(d.force) +
              ",\"showing\":" + showing_json(showing) + "}";
  return page.html();
}

}  // namespace tissue_stiffness
