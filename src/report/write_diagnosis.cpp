#include "tissue_stiffness/report/write_diagnosis.hpp"

#include <cmath>
#include <filesystem>

#include "tissue_stiffness/report/style.hpp"
#include "tissue_stiffness/report/text.hpp"
#include "tissue_stiffness/report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

std::string millimetres(double metres) {
  return std::isfinite(metres) ? short_number(1e3 * metres, 3) + " mm" : "-";
}

std::string words(std::string effect) {
  for (char& c : effect) c = c == '_' ? ' ' : c;
  return effect;
}

std::string join(const std::vector<std::string>& names, const std::string& separator) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : separator) + words(name);
  return text;
}

std::string bar(double length, const std::string& text) {
  const std::string width = short_number(std::min(100.0, std::max(0.0, 100.0 * length)), 3);
  return "<div class=\"bar\" style=\"background:linear-gradient(90deg,var(--band,#9cc4ee) " + width + "%,transparent " +
         width + "%)\">" + escape_html(text) + "</div>";
}

std::string staircase(const Diagnosis& d) {
  std::string text =
      "<section><h2>The error, step by step</h2><table><tr><th>model</th><th>held-out error</th><th>fitted frames</th>"
      "<th>noise</th></tr>";
  for (const DiagnosisStep& step : d.steps) {
    const std::string name = step.effects.empty() ? "as given" : "+ " + words(step.effects.back());
    text += "<tr><td>" + escape_html(name) + "</td><td style=\"min-width:14em\">" +
            bar(step.held_out_rms / d.steps.front().held_out_rms, millimetres(step.held_out_rms)) + "</td><td>" +
            millimetres(step.train_rms) + "</td><td>" + millimetres(step.noise_floor) + "</td></tr>";
  }
  return text + "</table></section>\n";
}

std::string ranking(const Diagnosis& d) {
  std::string text =
      "<section><h2>What could be missing</h2><table><tr><th>effect</th><th>explains</th><th>held-out error after"
      "</th><th>log evidence</th><th>p</th><th>looks like</th></tr>";
  for (const MissingEffect& c : d.candidates) {
    std::string twins;
    for (const auto& twin : c.confusable_with) {
      twins += (twins.empty() ? "" : ", ") + words(twin.effect) + " (" + short_number(twin.cosine, 2) + ")";
    }
    text += "<tr><td>" + escape_html(words(c.effect)) + "</td><td>" +
            bar(c.explained, short_number(100.0 * c.explained, 3) + " %") + "</td><td>" +
            millimetres(c.held_out_rms_after) + "</td><td>" + short_number(c.log_bayes_factor, 3) + "</td><td>" +
            short_number(c.p_value, 2) + "</td><td>" + escape_html(twins) + "</td></tr>";
  }
  return text + "</table></section>\n";
}

}  // namespace

std::string diagnosis_sentence(const Diagnosis& d) {
  if (d.verdict == "adequate") return "The model is adequate: what it leaves is noise.";
  if (d.verdict == "numerics") return "The mesh is too coarse to tell: a finer one would change more than any effect.";
  if (d.set.empty()) return "The error has structure, but no effect of the library explains it.";
  const MissingEffect& best = d.candidates.front();
  std::string text = d.verdict == "missing" ? "Missing: " : "Not explained; nearest: ";
  text += words(best.effect) + ", which would remove " + short_number(100.0 * best.explained, 3) +
          " % of the squared error (held-out error " + millimetres(best.held_out_rms_before) + " to " +
          millimetres(best.held_out_rms_after) + ").";
  if (d.set.size() > 1) {
    text += " These data fit as well: " + join({d.set.begin() + 1, d.set.end()}, ", ") + ".";
    if (!d.next_experiment.empty()) text += " To tell them apart: " + d.next_experiment + ".";
  }
  return text;
}

std::string diagnosis_html(const Diagnosis& d, const DiagnosisTexts& texts) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>Diagnosis</title><style>";
  page += report_style;
  page += "</style></head><body><main>\n<section><h1>" + escape_html(texts.model) + " · " + escape_html(texts.recording) +
          "</h1><p class=\"answer\"><b>" + escape_html(d.verdict) + "</b></p><p>" + escape_html(diagnosis_sentence(d)) +
          "</p><p>Where: " + escape_html(d.where) + ".<br>When: " + escape_html(d.when) + ".</p></section>\n";
  page += staircase(d) + ranking(d);
  if (!d.final_effects.empty()) {
    page += "<section><h2>With " + escape_html(join(d.final_effects, ", ")) + "</h2><p>" + escape_html(d.final_verdict) +
            "</p><pre>" + escape_html(texts.next_model_text) + "</pre></section>\n";
  }
  page += "<section><h2>The given model</h2><pre>" + escape_html(texts.model_text) + "</pre><p><small>" +
          escape_html(texts.command_line) + "</small></p></section>\n</main></body></html>\n";
  return page;
}

void write_diagnosis(const Diagnosis& d, const DiagnosisTexts& texts, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw InputError(directory, error.message(), "a writable folder");
  const std::filesystem::path folder(directory);
  write_text((folder / "diagnosis.json").string(), diagnosis_json(d));
  write_text((folder / "model_next.yaml").string(), texts.next_model_text);
  write_text((folder / "report.html").string(), diagnosis_html(d, texts));
}

}  // namespace tissue_stiffness
