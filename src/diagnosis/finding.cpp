#include "tissue_stiffness/diagnosis/finding.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tissue_stiffness/diagnosis/missing_force.hpp"
#include "tissue_stiffness/diagnosis/refit_list.hpp"
#include "tissue_stiffness/diagnosis/refit_search.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTwin = 0.9;  // cosine above which two effects look alike

void require_proposed(const FirstLook& look, const std::vector<std::string>& wanted) {
  for (const std::string& effect : wanted) {
    if (std::none_of(look.ranked.begin(), look.ranked.end(), [&](const Ranked& r) { return r.effect == effect; })) {
      throw InputError("--add", effect, "an effect that the library proposes for this model");
    }
  }
}

// How many ways of an effect the library proposes.
double ways_of(const FirstLook& look, const std::string& effect) {
  const auto same = [&](const Candidate& c) { return c.effect == effect; };
  return static_cast<double>(std::count_if(look.candidates.begin(), look.candidates.end(), same));
}

double effects_of(const FirstLook& look) {
  return static_cast<double>(std::max<std::size_t>(1, look.ranked.size()));
}

// Over all ways, of which one was fitted.
double log_bayes_factor(const FirstLook& look, const RefitList& refits, const Refit& refit) {
  return refit.assessment.log_evidence - refits.given().log_evidence - std::log(ways_of(look, refit.effect));
}

// Beforehand the given model is as probable as all effects together, and those are alike, whatever the ways each has.
Comparison compare(const FirstLook& look, const RefitList& refits) {
  const ModelComparison& models = refits.comparison();
  const double prior = -std::log(effects_of(look));
  const MisfitTest& given = refits.given().test;
  std::vector<double> weights{0.0};
  for (const Refit& r : refits.all()) weights.push_back(log_bayes_factor(look, refits, r) + prior);
  // The force acts on the residual of the fit; what the fit costs, and its weights, are the given model's.
  const double force = log_evidence_of_random_force(*look.base.study, look.base.fit.w, models.noise_variance());
  const double numerics = refits.given().log_likelihood - models.log_likelihood(look.base.rows);
  weights.push_back(force - numerics + prior);
  const std::vector<double> probability = posterior(weights);
  Comparison out;
  out.given = {{}, probability.front(), given.z(), given.passes()};
  out.structured = given.discrepancy() > 0.0;
  out.passes_without_mesh = models.test_of(look.base.rows.error, static_cast<double>(look.base.fit.w.size())).passes();
  for (std::size_t i = 0; i < refits.all().size(); ++i) {
    const Refit& refit = refits.all()[i];
    out.others.push_back({refit.effect, probability[1 + i], refit.assessment.test.z(), refit.assessment.test.passes()});
  }
  out.none_of_these = probability.back();
  return out;
}

// Effects of the fewest named explanations that hold the believed part of their probability, most probable first.
std::vector<std::string> set_of(const Comparison& comparison) {
  std::vector<const Explanation*> order;
  double all = 0.0, held = 0.0;
  for (const Explanation& e : comparison.others) {
    order.push_back(&e);
    all += e.probability;
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->probability > b->probability; });
  std::vector<std::string> set;
  for (const Explanation* e : order) {
    if (held > kComparison.believed * all) break;
    held += e->probability;
    set.push_back(e->effect);
  }
  return set;
}

// As the tangents have it.
MissingEffect describe(const FirstLook& look, const Ranked& r) {
  MissingEffect out;
  out.effect = r.effect;
  out.entry = r.best->proposal.yaml;
  out.log_bayes_factor = r.evidence;
  const Eigen::VectorXd& amplitude = r.score.amplitude;
  const double gain = r.score.explained / look.comparison.noise_variance();
  out.p_value = likelihood_ratio_p_value(gain, static_cast<double>(amplitude.size()));
  out.explained = r.score.explained / look.cost;
  for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
    const std::string suffix = amplitude.size() > 1 ? std::string("_") + "xyz"[i] : "";
    out.parameters[r.effect + "." + r.best->proposal.amplitude + suffix] = amplitude[i];
  }
  return out;
}

MissingEffect describe(const FirstLook& look, const RefitList& refits, const Refit& refit) {
  MissingEffect out;
  out.effect = refit.effect;
  out.entry = refit.entry;
  out.parameters = refit.parameters;
  out.log_bayes_factor = log_bayes_factor(look, refits, refit);
  const double gain = 2.0 * (refit.assessment.log_likelihood - refits.given().log_likelihood);
  out.p_value = likelihood_ratio_p_value(gain, static_cast<double>(parameters_of(*refit.way)));
  out.explained = 1.0 - refit.cost / look.cost;
  out.held_out_rms_after = refit.held_out_rms;
  return out;
}

// Refitted ones first, in the order of their refits; then the others, by the tangents' evidence.
std::vector<MissingEffect> describe(const FirstLook& look, const RefitList& refits) {
  std::vector<MissingEffect> out;
  for (const Refit& refit : refits.all()) out.push_back(describe(look, refits, refit));
  for (const Ranked& r : look.ranked) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const MissingEffect& e) { return e.effect == r.effect; });
    if (!known) out.push_back(describe(look, r));
  }
  const double before = rms_error(look.base.rows, look.base.study->recording(), true);
  for (MissingEffect& effect : out) {
    effect.held_out_rms_before = before;
    effect.size = std::sqrt(std::max(0.0, effect.explained) * look.cost / look.base.rows.count());
    const auto same = [&](const Ranked& r) { return r.effect == effect.effect; };
    const Score& own = std::find_if(look.ranked.begin(), look.ranked.end(), same)->score;
    for (const Ranked& other : look.ranked) {
      if (same(other)) continue;
      const double cosine = own.cosine_with(other.score);
      if (cosine > kTwin) effect.confusable_with.push_back({other.effect, cosine});
    }
  }
  return out;
}

void tell_belief(const Comparison& comparison, MissingEffect& effect) {
  for (const Explanation& e : comparison.others) {
    if (e.effect != effect.effect) continue;
    effect.probability = e.probability;
    effect.z = e.z;
  }
}

}  // namespace

Finding look(const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
             const FinerMesh& finer, const Library& library, const CandidatesSoFar& so_far) {
  const FirstLook look(base, options, finer, library);
  require_proposed(look, wanted);
  Finding out;
  RefitList refits(look, options, [&](const RefitList& fitted) { so_far(describe(look, fitted)); });
  so_far(describe(look, refits));
  search_refits(look, wanted, refits);
  out.comparison = compare(look, refits);
  out.models = std::make_shared<const ModelComparison>(refits.comparison());
  out.verdict = judge(out.comparison);
  if (out.verdict == Verdict::missing || out.verdict == Verdict::unexplained) out.set = set_of(out.comparison);
  out.effects = describe(look, refits);
  for (MissingEffect& effect : out.effects) tell_belief(out.comparison, effect);
  out.refits = refits.take();
  out.floor = look.floor;
  out.finer = look.finer;
  out.library = look.library;
  out.better_base = refits.better_base();
  return out;
}

}  // namespace tissue_stiffness
