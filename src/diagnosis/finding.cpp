#include "diagnosis/finding.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/refit_list.hpp"
#include "diagnosis/refit_search.hpp"

namespace tissue_stiffness {
namespace {

// Describes a candidate as the tangents have it.
MissingEffect describe_candidate(const Screening& screening, const Ranked& r) {
  MissingEffect out;
  out.effect = r.effect;
  out.entry = to_yaml(r.best().proposal.entry);
  out.log_bayes_factor = r.evidence;
  const Eigen::VectorXd& amplitude = r.score().amplitude;
  const double gain = r.score().explained / screening.comparison.noise_variance();
  out.p_value = likelihood_ratio_p_value(gain, static_cast<double>(amplitude.size()));
  out.explained = r.score().explained / screening.cost;
  for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
    const std::string suffix = amplitude.size() > 1 ? std::string("_") + "xyz"[i] : "";
    out.parameters[r.effect + "." + r.best().proposal.amplitude + suffix] = amplitude[i];
  }
  return out;
}

MissingEffect describe_candidate(const Screening& screening, const RefitList& refits, const Refit& refit) {
  MissingEffect out;
  out.effect = refit.effect;
  out.entry = to_yaml(refit.entry);
  out.parameters = refit.parameters;
  out.log_bayes_factor = refit.log_bayes_factor;
  const double gain = 2.0 * (refit.assessment.log_likelihood - refits.given().log_likelihood);
  out.p_value = likelihood_ratio_p_value(gain, static_cast<double>(parameters_of(*refit.candidate)));
  out.explained = 1.0 - refit.cost / screening.cost;
  out.held_out_rms_after = refit.held_out_rms;
  return out;
}

// Refitted effects come first, in the order of their refits; then the others, by the tangents' evidence.
std::vector<MissingEffect> describe_candidate(const Screening& screening, const RefitList& refits) {
  std::vector<MissingEffect> out;
  for (const Refit& refit : refits.all()) out.push_back(describe_candidate(screening, refits, refit));
  for (const Ranked& r : screening.ranked) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const MissingEffect& e) { return e.effect == r.effect; });
    if (!known) out.push_back(describe_candidate(screening, r));
  }
  const double before = rms_error(screening.base.rows, screening.base.recording_fit->recording(), true);
  for (MissingEffect& effect : out) {
    effect.held_out_rms_before = before;
    effect.size = std::sqrt(std::max(0.0, effect.explained) * screening.cost / screening.base.rows.count());
    const auto same = [&](const Ranked& r) { return r.effect == effect.effect; };
    const Score& own = std::find_if(screening.ranked.begin(), screening.ranked.end(), same)->score();
    for (const Ranked& other : screening.ranked) {
      if (same(other)) continue;
      const double cosine = own.cosine_with(other.score());
      if (cosine > kConfusable) effect.confusable_with.push_back({other.effect, cosine});
    }
  }
  return out;
}

}  // namespace

void Finding::believe(Comparison known) {
  comparison = std::move(known);
  verdict = judge(comparison);
  set.clear();
  if (verdict == Verdict::missing || verdict == Verdict::unexplained) set = believed_effects(comparison);
  for (MissingEffect& effect : effects) {
    effect.probability = comparison.probability_of(effect.effect);
    double most = -1.0;
    for (const Hypothesis& h : comparison.hypotheses) {
      if (!h.holds(effect.effect) || h.probability <= most) continue;
      most = h.probability;
      effect.z = h.test.z;
    }
  }
}

void Finding::judge_by(std::shared_ptr<const ModelComparison> likelihood) {
  models = std::move(likelihood);
  Comparison again = comparison;
  again.assess(*models);
  believe(std::move(again));
  const std::vector<std::string>& best = comparison.best().effects;
  if (!best.empty()) put_first(best.front());
}

void Finding::put_first(const std::string& effect) {
  const auto is_it = [&effect](const Refit& refit) { return refit.effect == effect; };
  const auto leader = std::find_if(refits.begin(), refits.end(), is_it);
  if (leader != refits.end()) std::rotate(refits.begin(), leader, leader + 1);
}

void Finding::take_over(const std::string& leader, const std::vector<MissingEffect>& deeper) {
  std::vector<MissingEffect>& known = effects;
  for (const MissingEffect& effect : deeper) {
    if (std::count(set.begin(), set.end(), effect.effect) == 0) continue;
    const auto at = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.effect == effect.effect; });
    if (at == known.end()) {
      known.push_back(effect);
    } else if (effect.effect != leader) {
      *at = effect;
    }
  }
}

Finding diagnose_once(FittedModel& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
                      const PreviousRound& previous, const CandidatesSoFar& so_far) {
  Screening screening(base, options, previous, wanted);
  Finding out;
  RefitList refits(screening, options, [&](const RefitList& fitted) { so_far(describe_candidate(screening, fitted)); });
  so_far(describe_candidate(screening, refits));
  if (wanted.empty()) {
    out.to_repeat = search_refits(screening, refits);
  } else {
    refit_effects(screening, refits);
  }
  if (!out.to_repeat) refits.test_best_by_own_numerics();
  out.models = std::make_shared<const ModelComparison>(refits.comparison());
  out.effects = describe_candidate(screening, refits);
  out.believe(refits.compare());
  out.refits = refits.take();
  out.failure = refits.failure();
  out.discretisation_error = screening.discretisation_error;
  const Library& library = wanted.empty() ? screening.library : previous.library;  // that of few effects serves nobody
  out.previous = {screening.finer.recording_fit, out.models, library, screening.beside_another};
  out.base_moved = refits.base_moved();
  return out;
}

}  // namespace tissue_stiffness
