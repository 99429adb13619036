#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "tissue_stiffness/diagnosis/ranking.hpp"
#include "tissue_stiffness/diagnosis/residual_views.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewestFrames = 18;
constexpr std::size_t kRefits = 6;      // candidates that are simulated anew
constexpr double kTwin = 0.9;           // cosine above which two effects look alike
constexpr double kSameEvidence = 5.0;   // log evidence within which refits are not told apart
constexpr double kAdequate = 1.1;       // rms in sigmas up to which a residual may be noise
constexpr double kExplains = 0.8;       // of the structured part: less is no explanation
constexpr double kHeldOutGain = 0.995;  // of the held-out rms: what an accepted effect must fall below
constexpr double kBaseSpread = 0.1;     // prior standard deviations, of the sigma points of the first fit

struct Fitted {
  ModelSettings settings;
  std::unique_ptr<Study> study;
  BatchFit fit;
  Study::Rows rows;
};

Fitted fit_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording) {
  Fitted out;
  out.settings = settings;
  out.study = std::make_unique<Study>(settings, mesh, recording);
  const Eigen::VectorXd start = out.study->scan(out.study->model().prior_mean());
  out.fit = out.study->fit(start, kBaseSpread * out.study->model().prior_std(), false);
  out.rows = out.study->rows(out.fit.w);
  return out;
}

DiagnosisStep step_of(const Fitted& model, const Recording& recording, const std::vector<std::string>& effects) {
  DiagnosisStep step;
  step.effects = effects;
  const auto& free = model.study->model().free_parameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    step.parameters[free[i].name] = free[i].to_value(model.fit.w[static_cast<Eigen::Index>(i)]);
  }
  step.train_rms = rms_error(model.rows, recording, false);
  step.held_out_rms = rms_error(model.rows, recording, true);
  step.noise_floor = noise_floor(model.rows);
  return step;
}

/// What one look at one model finds.
struct Finding {
  std::string verdict;
  std::vector<std::string> set;
  std::vector<MissingEffect> effects;
  std::vector<Refit> refits;  ///< best first
};

double rows_used(const Study::Rows& rows) {
  return static_cast<double>((rows.used.array() > 0.0).count());
}

// Evidence of a refit after Schwarz, errors counted as large as the best refit leaves them.
double evidence(const Refit& refit, double rows, double variance) {
  return -0.5 * refit.cost / variance - 0.5 * refit.added_parameters * std::log(rows);
}

std::vector<Refit> refit_best(const Fitted& base, const std::vector<Ranked>& ranked, const std::vector<std::string>& wanted,
                              const DiagnosisOptions& options) {
  std::vector<Refit> refits;
  for (const Ranked& r : ranked) {
    const bool asked = std::find(wanted.begin(), wanted.end(), r.effect) != wanted.end();
    if (!asked && (!r.declared || refits.size() >= kRefits || !wanted.empty())) continue;
    options.progress("refit with " + r.effect);
    try {
      refits.push_back(refit(*base.study, base.fit.w, r));
    } catch (const NumericalError&) {
      continue;  // a model that cannot be run explains nothing
    }
  }
  const double rows = rows_used(base.rows);
  double lowest = base.rows.error.squaredNorm();
  for (const Refit& r : refits) lowest = std::min(lowest, r.cost);
  const double variance = std::max(1.0, lowest / rows);
  std::stable_sort(refits.begin(), refits.end(), [&](const Refit& a, const Refit& b) {
    return evidence(a, rows, variance) > evidence(b, rows, variance);
  });
  return refits;
}

bool proven(const Fitted& base, const Refit& refit) {
  return refit.held_out_sigmas < kHeldOutGain * rms_sigmas(base.rows, base.study->recording(), true);
}

std::string judge(const Fitted& base, const std::vector<Ranked>& ranked, const std::vector<Refit>& refits) {
  const double rows = rows_used(base.rows), cost = base.rows.error.squaredNorm();
  const bool declared = std::any_of(ranked.begin(), ranked.end(), [](const Ranked& r) { return r.declared; });
  if (!declared) return cost < kAdequate * kAdequate * rows ? "adequate" : "unexplained";
  if (refits.empty() || !proven(base, refits.front())) {
    return cost < kAdequate * kAdequate * rows ? "adequate" : "unexplained";
  }
  const double structured = cost - rows;
  if (structured > 0.0 && cost - refits.front().cost < kExplains * structured) return "unexplained";
  return "missing";
}

std::vector<std::string> set_of(const Fitted& base, const std::vector<Refit>& refits) {
  std::vector<std::string> set;
  if (refits.empty()) return set;
  const double rows = rows_used(base.rows), variance = std::max(1.0, refits.front().cost / rows);
  const double best = evidence(refits.front(), rows, variance);
  for (const Refit& r : refits) {
    if (best - evidence(r, rows, variance) < kSameEvidence) set.push_back(r.effect);
  }
  return set;
}

MissingEffect describe(const Fitted& base, const Ranked& r, const std::vector<Ranked>& ranked,
                       const std::vector<Refit>& refits) {
  MissingEffect out;
  out.effect = r.effect;
  out.entry = r.best->proposal.yaml;
  out.log_bayes_factor = r.evidence;
  out.p_value = r.score.p_value;
  out.size = r.score.size;
  out.explained = r.score.explained;
  for (Eigen::Index i = 0; i < r.score.amplitude.size(); ++i) {
    const std::string suffix = r.score.amplitude.size() > 1 ? std::string("_") + "xyz"[i] : "";
    out.parameters[r.effect + "." + r.best->proposal.amplitude + suffix] = r.score.amplitude[i];
  }
  out.held_out_rms_before = rms_error(base.rows, base.study->recording(), true);
  for (const Refit& refit : refits) {
    if (refit.effect != r.effect) continue;
    out.parameters = refit.parameters;
    out.held_out_rms_after = refit.held_out_rms;
    out.explained = 1.0 - refit.cost / base.rows.error.squaredNorm();
    out.entry = refit.entry;
  }
  for (const Ranked& other : ranked) {
    if (other.effect == r.effect) continue;
    const double cosine = r.score.cosine_with(other.score);
    if (cosine > kTwin) out.confusable_with.push_back({other.effect, cosine});
  }
  return out;
}

Finding look(const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options) {
  options.progress("tangents of the library");
  const Eigen::VectorXd std = base.fit.covariance.diagonal().cwiseSqrt();
  const std::vector<Candidate> candidates = find_candidates(*base.study, base.fit.w, base.rows);
  const Scorer scorer(base.rows.error, base_tangents(*base.study, base.fit.w, std, base.rows), base.rows.offsets, 1.0);
  const std::vector<Ranked> ranked = rank(scorer, candidates, 0.0);
  for (const std::string& effect : wanted) {
    if (std::none_of(ranked.begin(), ranked.end(), [&](const Ranked& r) { return r.effect == effect; })) {
      throw InputError("--add", effect, "an effect that the library proposes for this model");
    }
  }
  Finding out;
  out.refits = refit_best(base, ranked, wanted, options);
  out.verdict = judge(base, ranked, out.refits);
  if (out.verdict == "missing" || out.verdict == "unexplained") out.set = set_of(base, out.refits);
  for (const Refit& r : out.refits) {
    const auto at = std::find_if(ranked.begin(), ranked.end(), [&](const Ranked& k) { return k.effect == r.effect; });
    out.effects.push_back(describe(base, *at, ranked, out.refits));
  }
  for (const Ranked& r : ranked) {
    const bool listed =
        std::any_of(out.effects.begin(), out.effects.end(), [&](const auto& e) { return e.effect == r.effect; });
    if (!listed) out.effects.push_back(describe(base, r, ranked, out.refits));
  }
  return out;
}

Fitted extended(const Fitted& base, const Refit& refit, const TetMesh& mesh, const Recording& recording) {
  Fitted out;
  out.settings = base.settings;
  add_effect(out.settings, refit.entry);
  out.study = std::make_unique<Study>(out.settings, mesh, recording);
  Eigen::VectorXd start = out.study->model().prior_mean();
  for (const auto& [name, value] : refit.parameters) {
    const Eigen::Index i = out.study->index(name);
    if (i >= 0) start[i] = out.study->model().free_parameters()[static_cast<std::size_t>(i)].to_coordinate(value);
  }
  out.fit = out.study->fit(start, kBaseSpread * 0.2 * out.study->model().prior_std(), false);
  out.rows = out.study->rows(out.fit.w);
  return out;
}

}  // namespace

Diagnosis diagnose(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                   const DiagnosisOptions& options) {
  const auto clock = std::chrono::steady_clock::now();
  if (recording.frames.size() < kFewestFrames) {
    throw InputError(settings.name, std::to_string(recording.frames.size()) + " usable frames",
                     "at least " + std::to_string(kFewestFrames) + " to hold some of them out");
  }
  Diagnosis out;
  options.progress("fit of the given model");
  Fitted model = fit_model(settings, mesh, recording);
  out.where = where_it_fails(*model.study, model.rows);
  out.when = when_it_fails(*model.study, model.rows);
  out.steps.push_back(step_of(model, recording, {}));

  Finding finding = look(model, {}, options);
  out.verdict = out.final_verdict = finding.verdict;
  out.set = finding.set;
  out.candidates = finding.effects;
  out.next_experiment = next_experiment(finding.set);

  std::vector<std::string> wanted = options.add;
  const auto most = static_cast<std::size_t>(options.automatic ? options.most_steps : 0) + wanted.size();
  for (std::size_t k = 0; k < most; ++k) {
    std::vector<Refit> refits = finding.refits;
    if (k < wanted.size()) {
      refits = look(model, {wanted[k]}, options).refits;
    } else if (finding.verdict == "adequate") {
      break;
    }
    if (refits.empty() || (k >= wanted.size() && !proven(model, refits.front()))) break;
    options.progress("add " + refits.front().effect);
    Fitted next = extended(model, refits.front(), mesh, recording);
    out.final_effects.push_back(refits.front().effect);
    out.entries.push_back(refits.front().entry);
    model = std::move(next);
    out.steps.push_back(step_of(model, recording, out.final_effects));
    finding = look(model, {}, options);
    out.final_verdict = finding.verdict;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return out;
}

}  // namespace tissue_stiffness
