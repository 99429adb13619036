#include <algorithm>

#include "report/candidate_list.hpp"
#include "report/difference_table.hpp"
#include "report/effect_words.hpp"
#include "report/failure.hpp"
#include "report/page.hpp"
#include "report/text.hpp"
#include "report/write_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

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

/// Returns a Young's modulus with its interval as the answer.
std::string modulus_answer(const std::string& name, const Diagnosis& d) {
  std::string text, interval, comma;
  for (const ParameterEstimate& p : d.estimate.parameters) {
    if (!is_young_modulus(p.name)) continue;
    const ShownUnit unit = shown_unit(p.mean, p.unit);
    const ShownEstimate shown = shown_estimate(p, unit.scale);
    text += comma + shown.mean + " " + unit.name;
    interval += (comma.empty() ? "95 %: " : comma) + shown.lower + " to " + shown.upper + " " + unit.name;
    comma = ", ";
  }
  if (text.empty()) text = shown_moduli(d.steps.back().parameters);
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

std::string model_name(const DiagnosisStep& step) {
  return step.effects.empty() ? "as given" : "with " + effect_list(step.effects);
}

/// Says which of the page's moduli is which.
std::string modulus_remark(const Diagnosis& d) {
  const bool estimated = !d.estimate.parameters.empty() && d.estimate.state != EstimateState::no_data;
  if (!estimated || shown_moduli(d.steps.front().parameters).empty()) return "";
  std::string fits = shown_moduli(d.steps.front().parameters) + " " + model_name(d.steps.front());
  if (d.steps.size() > 1) fits += " and " + shown_moduli(d.steps.back().parameters) + " " + model_name(d.steps.back());
  const bool mixed = !d.traces.empty() ||
                     std::any_of(d.rivals.begin(), d.rivals.end(), [](const auto& rivals) { return !rivals.empty(); });
  const std::string file = d.final_effects.empty() ? "the given model" : "model_next.yaml";
  return "<p class=\"soft\">" +
         escape_html("This is the estimate of " + file + (mixed ? ", averaged over the effects that may also act" : "") +
                     ". It counts the errors of mesh and inputs. Best fits of E do not: they "
                     "are " +
                     fits + ".") +
         "</p>";
}

std::string answer(const Diagnosis& d) {
  std::string text = interruption_notice(d.interrupted) + "<p>" + verdict_badge(d.verdict) + "</p><p class=\"verdict\">" +
                     escape_html(diagnosis_sentence(d, d.candidates.empty())) + "</p>";
  if (d.steps.empty()) return section("answer", "", text);
  if (d.steps.size() == 1) {
    text += modulus_answer("Young's modulus of the given model", d);
  } else {
    text += modulus_answer("Young's modulus, " + model_name(d.steps.back()), d) + "<p>" + verdict_badge(d.final_verdict) +
            " " + escape_html(model_name(d.steps.back())) + "</p>";
  }
  return section("answer", "", text + modulus_remark(d));
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
            millimetres(step.noise_floor) + "</td><td class=\"n\">" + escape_html(shown_moduli(step.parameters)) +
            "</td><td class=\"n\">" + (step.effects.empty() ? "" : short_number(step.log_bayes_factor, 3)) + "</td></tr>";
  }
  return section("staircase", "The error, step by step",
                 chart_place("steps") +
                     "<div class=\"scroll\"><table class=\"stacked\"><thead><tr><th>model</th><th class=\"n\">held-out "
                     "error</th><th class=\"n\">fitted frames</th><th class=\"n\">noise</th><th class=\"n\">best fit "
                     "of E</th><th class=\"n\" title=\"log evidence that the last effect gains\">log Bayes "
                     "factor</th></tr></thead>" +
                     rows + "</table></div>");
}

/// Says in which entries the proposed model differs, with both files to unfold.
std::string models(const Diagnosis& d, const DiagnosisTexts& texts) {
  const std::string given = file_details("The given model", texts.model_text, d.final_effects.empty());
  if (d.final_effects.empty()) return section("model", "", given);
  return section("model", "What the proposed model changes",
                 difference_table({"the given model", texts.model_text}, {"model_next.yaml", texts.next_model_text}) +
                     given + file_details("The proposed model: model_next.yaml", texts.next_model_text, false));
}

}  // namespace

std::string diagnosis_html(const Diagnosis& d, const DiagnosisTexts& texts, const Showing& showing) {
  Page page;
  page.title = short_path(texts.model) + " - diagnosis";
  page.heading = "What does the model miss?";
  page.subheading = short_path(texts.model) + " · " + short_path(texts.recording);
  page.body = answer(d) + player(showing, !d.force.time.empty()) + failure(d) + validity(d) +
              candidate_list(d, texts.units) + staircase(d) + models(d, texts) +
              colophon(texts.command_line, texts.versions, "The diagnosis took " + short_number(d.seconds, 3) + " s.");
  page.data = "{\"diagnosis\":" + diagnosis_json(d) + ",\"arrows\":" + arrows_json(d.force) +
              ",\"showing\":" + showing_json(showing) + "}";
  return page.html();
}

}  // namespace tissue_stiffness
