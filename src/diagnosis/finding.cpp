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
  return static_cast<double>(
      std::max<std::ptrdiff_t>(1, std::count_if(look.candidates.begin(), look.candidates.end(), same)));
}

// Beforehand the given model is as probable as all effects together, and those are alike, whatever the ways each has.
double log_prior(const FirstLook& look, const Refit& refit) {
  const double effects = static_cast<double>(std::max<std::size_t>(1, look.ranked.size()));
  double out = 0.0;
  for (const std::string& effect : refit.effects) out -= std::log(effects * ways_of(look, effect));
  return out;
}

Comparison compare(const FirstLook& look, const RefitList& refits) {
  const ModelComparison& models = refits.comparison();
  const double effects = static_cast<double>(std::max<std::size_t>(1, look.ranked.size()));
  const double base = refits.log_evidence_of_base();
  const MisfitTest given = models.test(refits.base());
  std::vector<double> weights{0.0};
  for (const Refit& r : refits.all()) weights.push_back(refits.log_evidence(r) - base + log_prior(look, r));
  // The force acts on the residual of the fit; what the fit costs, and its weights, are the given model's.
  const double force = log_evidence_of_random_force(*look.base.study, look.base.fit.w, models.noise_variance());
  const double numerics = models.log_likelihood(refits.base()) - models.log_likelihood(look.base.rows);
  weights.push_back(force - numerics - std::log(effects));
  const std::vector<double> probability = posterior(weights);
  Comparison out;
  out.given = {{}, probability.front(), given.z(), given.passes()};
  out.structured = given.discrepancy() > 0.0;
  out.passes_without_mesh = models.test_of(look.base.rows.error, static_cast<double>(look.base.fit.w.size())).passes();
  for (std::size_t i = 0; i < refits.all().size(); ++i) {
    const MisfitTest test = refits.test(refits.all()[i]);
    out.others.push_back({refits.all()[i].effects, probability[1 + i], test.z(), test.passes()});
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
    for (const std::string& effect : e->effects) {
      if (std::find(set.begin(), set.end(), effect) == set.end()) set.push_back(effect);
    }
  }
  return set;
}

MissingEffect describe(const FirstLook& look, const std::vector<Refit>& refits, const Ranked& r) {
  MissingEffect out;
  out.effect = r.effect;
  out.entry = r.best->proposal.yaml;
  out.log_bayes_factor = r.evidence;
  out.p_value = r.p_value;
  out.size = r.score.size;
  out.explained = r.score.explained;
  for (Eigen::Index i = 0; i < r.score.amplitude.size(); ++i) {
    const std::string suffix = r.score.amplitude.size() > 1 ? std::string("_") + "xyz"[i] : "";
    out.parameters[r.effect + "." + r.best->proposal.amplitude + suffix] = r.score.amplitude[i];
  }
  out.held_out_rms_before = rms_error(look.base.rows, look.base.study->recording(), true);
  for (const std::size_t size : {2, 1}) {  // its own refit says more of it than a pair's
    const auto refit = std::find_if(refits.begin(), refits.end(), [&](const Refit& known) {
      return known.effects.size() == size && std::count(known.effects.begin(), known.effects.end(), r.effect) > 0;
    });
    if (refit == refits.end()) continue;
    const auto at = std::find(refit->effects.begin(), refit->effects.end(), r.effect) - refit->effects.begin();
    out.parameters = refit->parameters;
    out.held_out_rms_after = refit->held_out_rms;
    out.p_value = refit->p_value;
    out.explained = 1.0 - refit->cost / look.cost;
    out.entry = refit->entries[static_cast<std::size_t>(at)];
  }
  for (const Ranked& other : look.ranked) {
    if (other.effect == r.effect) continue;
    const double cosine = r.score.cosine_with(other.score);
    if (cosine > kTwin) out.confusable_with.push_back({other.effect, cosine});
  }
  return out;
}

// Refitted ones first, in the order of their refits; then the others, by the tangents' evidence.
std::vector<MissingEffect> describe(const FirstLook& look, const std::vector<Refit>& refits) {
  std::vector<MissingEffect> out;
  std::vector<std::string> order;
  for (const Refit& refit : refits) order.insert(order.end(), refit.effects.begin(), refit.effects.end());
  for (const Ranked& r : look.ranked) order.push_back(r.effect);
  for (const std::string& effect : order) {
    if (std::any_of(out.begin(), out.end(), [&](const MissingEffect& known) { return known.effect == effect; })) continue;
    const auto ranked =
        std::find_if(look.ranked.begin(), look.ranked.end(), [&](const Ranked& r) { return r.effect == effect; });
    out.push_back(describe(look, refits, *ranked));
  }
  return out;
}

// Probability of all explanations with an effect, and the test of the most probable one.
void tell_belief(const Comparison& comparison, MissingEffect& effect) {
  double most = -1.0;
  for (const Explanation& e : comparison.others) {
    if (std::count(e.effects.begin(), e.effects.end(), effect.effect) == 0) continue;
    effect.probability += e.probability;
    if (e.probability <= most) continue;
    most = e.probability;
    effect.z = e.z;
  }
}

}  // namespace

Finding look(const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
             const FinerMesh& finer, const Library& library, const CandidatesSoFar& so_far) {
  const FirstLook look(base, options, finer, library);
  require_proposed(look, wanted);
  Finding out;
  so_far(describe(look, {}));
  const auto refitted = [&](const std::vector<Refit>& refits) { so_far(describe(look, refits)); };
  RefitList refits = search_refits(look, wanted, options, refitted);
  out.comparison = compare(look, refits);
  out.models = std::make_shared<const ModelComparison>(refits.comparison());
  out.refits = refits.take();
  out.verdict = judge(out.comparison);
  if (out.verdict == Verdict::missing || out.verdict == Verdict::unexplained) out.set = set_of(out.comparison);
  out.effects = describe(look, out.refits);
  for (MissingEffect& effect : out.effects) tell_belief(out.comparison, effect);
  out.floor = look.floor;
  out.finer = look.finer;
  out.library = look.library;
  return out;
}

}  // namespace tissue_stiffness
