#include "report/write_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "report/effect_words.hpp"
#include "report/text.hpp"
#include "report/write_results.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTold = 0.005;   // probability
constexpr double kTraced = 0.05;  // and that of a trace

// Returns "Probabilities: viscous damping 94 %, viscoelasticity 5 %, none of these 1 %."
std::string probabilities(const Diagnosis& d) {
  std::vector<std::pair<double, std::string>> all;
  const auto add = [&all](double probability, const std::string& name) {
    if (probability >= kTold) all.emplace_back(probability, name);  // not where it is unknown
  };
  add(d.none_of_these, "none of these");
  add(d.adequate, "the model as given");
  for (const MissingEffect& c : d.candidates) add(c.probability, effect_title(c.effect));
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [probability, name] : all) {
    text +=
        (text.empty() ? " Probabilities: " : ", ") + name + " " + std::to_string(std::lround(100.0 * probability)) + " %";
  }
  return text.empty() ? text : text + ".";
}

// Returns "E's interval allows for what may act unseen: added mass (49 %, E 10 % higher)."
std::string traces(const Diagnosis& d) {
  std::string list;
  for (const RivalExplanation& trace : d.traces) {
    std::string changes;
    for (const auto& [name, ratio] : trace.modulus_ratio) {
      const long percent = std::lround(100.0 * std::abs(ratio - 1.0));
      if (percent > 0) {
        changes += ", " + (trace.modulus_ratio.size() == 1 ? "E" : name) + " " + std::to_string(percent) + " % " +
                   (ratio > 1.0 ? "higher" : "lower");
      }
    }
    if (trace.probability < kTraced || changes.empty()) continue;
    list += (list.empty() ? "" : ", ") + effect_title(trace.effect) + " (" +
            std::to_string(std::lround(100.0 * trace.probability)) + " %" + changes + ")";
  }
  if (list.empty()) return "";
  return " E's interval allows for what may act unseen: " + list + ".";
}

// Returns why nothing is named.
std::string rejection(const Diagnosis& d) {
  double named = 0.0;
  for (const MissingEffect& c : d.candidates) named = std::max(named, c.probability);
  return named > d.none_of_these ? " That is not certain enough for a name." : " None of them explains the data.";
}

std::string verdict_sentence(const Diagnosis& d, bool with_probabilities) {
  if (d.verdict == Verdict::unfinished) return "There is no verdict yet: the search for what is missing was interrupted.";
  if (d.verdict == Verdict::adequate) return "The model is adequate: what it leaves is noise.";
  if (d.verdict == Verdict::numerics) {
    return "The model is adequate but for the numerics: errors of the mesh, or of a simulated recording's time steps, may "
           "be all that it leaves. A finer mesh would tell: `mesh: {refine: 1}`.";
  }
  if (d.best.effects.empty()) return "The error has structure, but no effect of the library explains it.";
  const bool together = d.best.effects.size() > 1;
  const std::vector<std::string>& found = d.best.effects;
  std::string text = d.verdict == Verdict::missing ? "Missing: " : "Not explained; nearest: ";
  text += effect_list(found) + (together ? " together" : " (" + effect_sign(found.front()) + ")") +
          (together ? ". They" : ". It") + " would remove " + short_number(100.0 * d.best.explained, 3) +
          " % of the squared error (held-out error " + millimetres(d.steps.front().held_out_rms) + " to " +
          millimetres(d.best.held_out_rms) + ").";
  if (with_probabilities) text += probabilities(d);
  if (d.verdict == Verdict::unexplained) text += rejection(d);
  const std::vector<std::string> others = others_in_set(d.set, d.best);
  if (!others.empty()) {
    text += " These data fit as well: " + effect_list(others) + ".";
    const auto rivalled = [](const std::vector<RivalExplanation>& rivals) { return !rivals.empty(); };
    if (std::any_of(d.rivals.begin(), d.rivals.end(), rivalled)) {
      text += " Young's modulus is the mixture of what they lead to.";
    }
    if (!d.next_experiment.empty()) text += " To tell them apart: " + effect_title(d.next_experiment) + ".";
  }
  return text;
}

}  // namespace

std::string diagnosis_sentence(const Diagnosis& d, bool with_probabilities) {
  const std::string failure = d.failure.empty() ? "" : " But " + d.failure + ".";
  const std::string left_out = d.left_out.empty() ? "" : " Left out: " + d.left_out + ".";
  return verdict_sentence(d, with_probabilities) + traces(d) + failure + left_out;
}

void write_diagnosis(const Diagnosis& d, const DiagnosisTexts& texts, const Showing& showing,
                     const std::string& directory) {
  make_folder(directory);
  const std::filesystem::path folder(directory);
  write_text((folder / "model_next.yaml").string(), texts.next_model_text);
  write_text((folder / "report.html").string(), diagnosis_html(d, texts, showing));
  write_text((folder / "diagnosis.json").string(), diagnosis_json(d));
}

}  // namespace tissue_stiffness
