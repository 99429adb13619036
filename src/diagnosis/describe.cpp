#include "diagnosis/describe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "diagnosis/residual_views.hpp"

namespace tissue_stiffness {
namespace {

std::map<std::string, double> modulus_ratios(const std::map<std::string, double>& parameters,
                                             const std::map<std::string, double>& over) {
  std::map<std::string, double> out;
  for (const auto& [name, value] : parameters) {
    const auto own = over.find(name);
    if (is_young_modulus(name) && own != over.end()) out[name] = value / own->second;
  }
  return out;
}

// Returns the rows with the residual that is compared.
RecordingRows rows_as_compared(const FittedModel& model, const Explained& explained) {
  RecordingRows out = model.rows;
  out.error = explained.error;
  return out;
}

}  // namespace

DiagnosisStep describe_step(const FittedModel& model, const Explained& explained, const std::vector<std::string>& effects) {
  const Recording& recording = model.recording_fit->recording();
  DiagnosisStep step;
  step.effects = effects;
  step.parameters = model.recording_fit->model().parameters().values(model.fit.w);
  const RecordingRows compared = rows_as_compared(model, explained);
  step.train_rms = rms_error(compared, recording, false);
  step.held_out_rms = rms_error(compared, recording, true);
  step.noise_floor = noise_floor(model.rows);
  return step;
}

void describe_residual(const FittedModel& model, Diagnosis& out) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // what the mesh changes is not known yet
  out.where = where_it_fails(*model.recording_fit, model.rows);
  out.when = when_it_fails(*model.recording_fit, model.rows);
  out.residual = residual_views(*model.recording_fit, model.rows);
  const double count = model.rows.count();
  const double sigma = noise_floor(model.rows);
  out.sigmas = {std::sqrt(model.rows.error.squaredNorm() / count), 1.0, unknown, 0.0};
  out.sigmas.structured = std::sqrt(std::max(0.0, out.sigmas.total * out.sigmas.total - 1.0));
  const double total = rms_error(model.rows);
  out.metres = {total, sigma, unknown, std::sqrt(std::max(0.0, total * total - sigma * sigma))};
}

BestExplanation best_explanation(const FittedModel& model, const Comparison& comparison) {
  const std::vector<Hypothesis> named = named_hypotheses(comparison);
  if (named.empty()) return {};
  const Hypothesis& best = named.front();
  const RecordingRows compared = rows_as_compared(model, *best.explained);
  return {best.effects, 1.0 - compared.error.squaredNorm() / model.rows.error.squaredNorm(),
          rms_error(compared, model.recording_fit->recording(), true)};
}

std::vector<RivalExplanation> rivals_of(const Finding& finding, const Refit& added) {
  const auto believed = [&](const std::string& effect) {
    return std::find(finding.set.begin(), finding.set.end(), effect) != finding.set.end();
  };
  if (!believed(added.effect)) return {};
  std::vector<RivalExplanation> out;
  double all = 0.0;
  for (const MissingEffect& effect : finding.effects) {
    if (!believed(effect.effect)) continue;
    all += effect.probability;
    if (effect.effect == added.effect) continue;
    out.push_back({effect.effect, effect.probability, modulus_ratios(effect.parameters, added.parameters)});
  }
  for (RivalExplanation& rival : out) rival.probability = all > 0.0 ? rival.probability / all : 0.0;
  return out;
}

std::vector<RivalExplanation> traces_of(const Finding& finding, const FittedModel& last) {
  const std::map<std::string, double> own = last.recording_fit->model().parameters().values(last.fit.w);
  std::vector<RivalExplanation> out;
  for (const Trace& trace : finding.comparison.traces()) {
    const auto same = [&](const Refit& r) { return r.effect == trace.hypothesis->effects.back(); };
    const auto refit = std::find_if(finding.refits.begin(), finding.refits.end(), same);
    if (trace.hypothesis->effects.size() > 1 || refit == finding.refits.end()) continue;
    out.push_back({refit->effect, trace.share, modulus_ratios(refit->parameters, own)});
  }
  return out;
}

}  // namespace tissue_stiffness
