#include "tissue_stiffness/diagnosis/finding.hpp"

#include <algorithm>

#include "tissue_stiffness/diagnosis/refit_list.hpp"
#include "tissue_stiffness/diagnosis/refit_search.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTwin = 0.9;           // cosine above which two effects look alike
constexpr double kHeldOutGain = 0.995;  // of the held-out rms: what an accepted effect must fall below

void require_proposed(const FirstLook& look, const std::vector<std::string>& wanted) {
  for (const std::string& effect : wanted) {
    if (std::none_of(look.ranked.begin(), look.ranked.end(), [&](const Ranked& r) { return r.effect == effect; })) {
      throw InputError("--add", effect, "an effect that the library proposes for this model");
    }
  }
}

std::string judge(const FirstLook& look, const std::vector<Refit>& refits) {
  const double left = refits.empty() ? look.cost : refits.front().cost;
  // An effect has to explain more than the mesh's error, which another mesh would change.
  const bool gained =
      !refits.empty() && proven(look.base, refits.front()) && look.cost - left > look.floor * look.floor * look.rows;
  // Within the noise, what the mesh explains about as well is no sign of an effect.
  if (look.noise() && (!gained || look.by_mesh > 0.5 * (look.cost - left))) return "adequate";
  if (look.numerics()) return "numerics";
  return gained && look.explained_by(refits.front()) ? "missing" : "unexplained";
}

std::vector<std::string> set_of(const FirstLook& look, const std::vector<Refit>& refits) {
  std::vector<std::string> set;
  if (refits.empty()) return set;
  const double variance = std::max(1.0, refits.front().cost_beside_numerics / look.rows);
  const double best = evidence(refits.front(), look.rows, variance);
  const double by_a_finer_mesh = kRemainder * look.floor * look.floor * look.rows;
  for (const Refit& r : refits) {
    const bool larger = r.effects.size() > refits.front().effects.size();
    const bool alike = best - evidence(r, look.rows, variance) < kSameEvidence ||
                       r.cost_beside_numerics - refits.front().cost_beside_numerics < by_a_finer_mesh;
    if (larger || !alike) continue;
    for (const std::string& effect : r.effects) {
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

}  // namespace

bool proven(const Fitted& base, const Refit& refit) {
  return refit.held_out_sigmas < kHeldOutGain * rms_sigmas(base.rows, base.study->recording(), true);
}

Finding look(const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
             const FinerMesh& finer, const Library& library, const CandidatesSoFar& so_far) {
  const FirstLook look(base, options, finer, library);
  require_proposed(look, wanted);
  Finding out;
  so_far(describe(look, {}));
  const auto refitted = [&](const std::vector<Refit>& refits) { so_far(describe(look, refits)); };
  out.refits = search_refits(look, wanted, options, refitted);
  out.verdict = judge(look, out.refits);
  if (out.verdict == "missing" || out.verdict == "unexplained") out.set = set_of(look, out.refits);
  out.effects = describe(look, out.refits);
  out.floor = look.floor;
  out.finer = look.finer;
  out.library = look.library;
  return out;
}

}  // namespace tissue_stiffness
