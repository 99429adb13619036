#include "diagnosis/refit_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kSameVariant = 0.8;      // cosine above which two variants are one
constexpr std::size_t kWarmStarts = 6;    // places that a stage finds and from which the whole recording is fitted
constexpr std::size_t kWarmStartsOf = 2;  // those of one effect
constexpr std::size_t kLeaders = 3;       // refits whose other variants are tried
constexpr int kRounds = 3;                // in which they are tried
constexpr std::size_t kTogether = 2;      // nonlinear refits that are fitted side by side

/// The search goes stage by stage, and only while nothing explains the recording.
class RefitSearch {
 public:
  RefitSearch(const Screening& screening, RefitList& refits) : screening_(screening), refits_(refits) {}

  /// See refit_effects.
  void all_in_full() {
    std::vector<RefitTask> list;
    for (const Ranked& r : screening_.ranked) {
      for (RefitTask& task : tasks_of(r)) list.push_back(std::move(task));
    }
    for (RefitTask& task : list) task.in_full = true;
    refits_.add(list);
    if (screening_.beside_another && wide() && !explained()) refit_from_initial_segment();
  }

  /// See search_refits.
  bool all() {
    const bool about_run = screening_.base.recording_fit->may_be_linearised();
    about_run ? refit_in_turn() : refit_from_tangents();
    if (!screening_.settled && refits_.move_to_better_base()) return !explained();
    if (!wide()) return false;
    if (!explained()) about_run ? refit_other_tangents() : refit_other_variants(1);
    if (!explained()) refit_from_initial_segment();
    if (about_run) return false;
    refit_other_variants(kRounds);  // of those that lead now
    if (!explained() && !screening_.beside_another) refit_faint_nonlinear_effects();
    return false;
  }

 private:
  void refit_from_tangents();
  void refit_in_turn();
  void refit_other_variants(int rounds);
  void refit_other_tangents();
  void refit_from_initial_segment();
  void refit_faint_nonlinear_effects();
  std::vector<const Candidate*> most_evident_initially() const;
  std::vector<Refit> leaders() const;

  /// A refit may start here.
  struct Start {
    const Candidate* candidate = nullptr;
    RankedFit at{{}, std::numeric_limits<double>::infinity()};
  };
  static std::vector<RefitTask> warm_started(std::vector<Start> starts);
  static std::map<std::string, double> parameters_for(const Candidate& candidate, const Refit& leader);
  /// Returns whether something is to be explained that tangents may not show. What a model that already has an effect
  /// leaves is small once it passes its test, and tangents are taken at the right place.
  bool wide() const {
    return screening_.beside_another ? !screening_.given.test.passes() : screening_.given.test.discrepancy() > 0.0;
  }
  /// Returns whether the tangent of a nonlinear effect explains little. Fits of such effects take long.
  bool faint(const Ranked& r) const {
    return !r.best().linear && !(r.score().explained > kComparison.promising * structured_squares(screening_.base.rows));
  }
  // Returns one for each form of the effect. Tangents at different places of the model do not tell forms apart.
  static std::vector<RefitTask> tasks_of(const Ranked& r) {
    std::vector<RefitTask> out;
    for (const ScoredCandidate& form : r.forms) out.push_back({form.candidate, form.score.amplitude});
    return out;
  }
  Verdict verdict() const { return judge(refits_.compare()); }
  bool explained() const { return verdict() == Verdict::missing; }

  const Screening& screening_;
  RefitList& refits_;
  std::set<std::pair<std::string, double>> explored_;  ///< leaders whose variants were tried, with what they were `fitted`
};

// Refits every effect where something is to be explained. Elsewhere a tangent has to speak for some effect; then all that
// tangents hardly tell from it are refitted. The first one goes alone: what falls behind it need not be fitted to the end.
void RefitSearch::refit_from_tangents() {
  std::vector<RefitTask> first, others;
  const double most = screening_.ranked.empty() ? 0.0 : screening_.ranked.front().evidence;
  const double least = most > kComparison.worthwhile ? most - 2.0 * kComparison.worthwhile : most + 1.0;
  for (const Ranked& r : screening_.ranked) {
    if (faint(r) || (!wide() && r.evidence < least)) continue;
    for (RefitTask& task : tasks_of(r)) (first.empty() ? first : others).push_back(std::move(task));
  }
  refits_.add(first);
  refits_.add(others);
}

// Every fit of a nonlinear model takes long, and its tangents are those of its run. So effects are fitted in the order of
// their evidence, until one explains the recording. Then those follow whose tangents are hardly told from its own.
void RefitSearch::refit_in_turn() {
  std::vector<const Ranked*> left;
  for (const Ranked& r : screening_.ranked) {
    if (r.evidence > kComparison.worthwhile) left.push_back(&r);
  }
  auto next = left.begin();
  while (next != left.end() && !explained()) {
    std::vector<RefitTask> together;
    for (; next != left.end() && together.size() < kTogether; ++next)
      together.push_back({&(*next)->best(), (*next)->score().amplitude});
    refits_.add(together);
  }
  if (!explained()) return;
  const Score known = screening_.scorer->score(refits_.best().candidate->tangent);
  std::vector<RefitTask> rivals;
  for (; next != left.end(); ++next) {
    if ((*next)->score().cosine_with(known) > kConfusable) rivals.push_back({&(*next)->best(), (*next)->score().amplitude});
  }
  refits_.add(rivals);
}

// Returns up to kLeaders refits, best first. They are copies, because the list changes while they are used.
std::vector<Refit> RefitSearch::leaders() const {
  std::vector<Refit> out;
  for (const Refit& refit : refits_.all()) {
    if (out.size() < kLeaders) out.push_back(refit);
  }
  return out;
}

// Tangents choose badly between the variants of an effect, and so do their costs where the leader fits. So each other
// variant of the leaders is fitted from there in few vectors, and the best fits are made anew. A leader that fits better
// now is the next round's.
void RefitSearch::refit_other_variants(int rounds) {
  if (rounds == 0 || explained()) return;
  struct Variant {
    const Candidate* candidate;
    std::map<std::string, double> from;
    double rival;
  };
  std::vector<Variant> variants;
  for (const Refit& leader : leaders()) {
    if (!explored_.insert({leader.effect, leader.fitted}).second) continue;
    for (const Candidate& candidate : screening_.candidates) {
      if (candidate.effect == leader.effect && candidate.linear && &candidate != leader.candidate)
        variants.push_back({&candidate, parameters_for(candidate, leader), leader.fitted});
    }
  }
  if (variants.empty()) return;
  std::vector<Start> starts(variants.size());
  refits_.try_each(
      variants.size(), [&](std::size_t i) { return "variants of " + variants[i].candidate->effect; },
      [&](std::size_t i) {
        const Variant& variant = variants[i];
        starts[i] = {variant.candidate, fit_variant(screening_.base, *variant.candidate, variant.from, variant.rival)};
      });
  refits_.add(warm_started(std::move(starts)));
  refit_other_variants(rounds - 1);
}

// Returns where a variant starts: where its leader fits. If they differ in a place, the leader's place is not taken over.
std::map<std::string, double> RefitSearch::parameters_for(const Candidate& candidate, const Refit& leader) {
  if (candidate.proposal.is_other_kind_of(leader.candidate->proposal)) return leader.parameters;
  const std::string own = leader.effect + ".", amplitude = own + candidate.proposal.amplitude;
  std::map<std::string, double> out;
  for (const auto& [name, value] : leader.parameters) {
    if (name.rfind(own, 0) != 0 || name.rfind(amplitude, 0) == 0) out[name] = value;
  }
  return out;
}

// A variant of a nonlinear model is too slow to run only to be ranked, so its tangent ranks it.
void RefitSearch::refit_other_tangents() {
  std::vector<RefitTask> list;
  for (const Refit& leader : leaders()) {
    const Score known = screening_.scorer->score(leader.candidate->tangent);
    const Candidate* other = nullptr;
    Score best;
    for (const Candidate& candidate : screening_.candidates) {
      if (candidate.effect != leader.effect || &candidate == leader.candidate) continue;
      Score score = screening_.scorer->score(candidate.tangent);
      if (score.cosine_with(known) > kSameVariant || !candidate.allows(score.amplitude)) continue;
      if (other != nullptr && score.log_bayes_factor <= best.log_bayes_factor) continue;
      other = &candidate;
      best = std::move(score);
    }
    if (other != nullptr) list.push_back({other, best.amplitude});
  }
  refits_.add(list);
}

// A tangent says little of an effect that changes the frequencies, and "unexplained" is said of what was tried.
void RefitSearch::refit_faint_nonlinear_effects() {
  std::vector<RefitTask> list;
  for (const Ranked& r : screening_.ranked) {
    if (faint(r) && r.evidence > kComparison.worthwhile) list.push_back({&r.best(), r.score().amplitude});
  }
  refits_.add(list);
}

// Where phases have drifted apart a tangent says little: what is unexplained may be any effect's, of any direction and
// strength. The best fits of the initial segment tell where to start.
void RefitSearch::refit_from_initial_segment() {
  const std::vector<const Candidate*> variants = most_evident_initially();
  std::vector<Start> starts(variants.size());
  refits_.try_each(
      variants.size(), [&](std::size_t i) { return "initial segment with " + variants[i]->effect; },
      [&](std::size_t i) {
        starts[i] = {variants[i], fit_initial_segment(screening_.base, *variants[i])};
      });
  refits_.add(warm_started(std::move(starts)));
}

// Returns fits from the best starts, of which at most kWarmStartsOf are of one effect.
std::vector<RefitTask> RefitSearch::warm_started(std::vector<Start> starts) {
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.at.deviance < b.at.deviance; });
  std::vector<RefitTask> out;
  std::map<std::string, std::size_t> taken;
  for (Start& start : starts) {
    if (std::isfinite(start.at.deviance) && out.size() < kWarmStarts && taken[start.candidate->effect]++ < kWarmStartsOf)
      out.push_back({start.candidate, {}, std::move(start.at.parameters)});
  }
  return out;
}

// Returns for each effect and kind the candidate with most evidence in the initial segment.
std::vector<const Candidate*> RefitSearch::most_evident_initially() const {
  const std::vector<Eigen::Index>& offsets = screening_.base.rows.offsets;
  const Eigen::Index rows = offsets[static_cast<std::size_t>(kInitialSegment * static_cast<double>(offsets.size() - 1))];
  const Scorer scorer(screening_.error.head(rows), screening_.nuisance_tangents.topRows(rows),
                      screening_.comparison.noise_variance());
  std::map<std::string, std::pair<double, const Candidate*>> best;
  for (const Candidate& candidate : screening_.candidates) {
    if (!candidate.linear) continue;
    const Tangent initial{candidate.tangent.columns.topRows(rows), candidate.tangent.prior_std};
    const double evidence = scorer.score(initial).log_bayes_factor;
    auto& known = best[candidate.effect + " " + candidate.proposal.kind()];
    if (known.second == nullptr || evidence > known.first) known = {evidence, &candidate};
  }
  std::vector<const Candidate*> out;
  for (const auto& [kind, known] : best) out.push_back(known.second);
  return out;
}

}  // namespace

bool search_refits(const Screening& screening, RefitList& refits) {
  return RefitSearch(screening, refits).all();
}

void refit_effects(const Screening& screening, RefitList& refits) {
  RefitSearch(screening, refits).all_in_full();
}

}  // namespace tissue_stiffness
