#include "tissue_stiffness/diagnosis/refit_search.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kSameWay = 0.8;     // cosine above which two ways are one
constexpr std::size_t kBegun = 6;    // fits of the beginning that are tried on the whole recording
constexpr std::size_t kBegunOf = 2;  // of one effect
constexpr std::size_t kLeaders = 3;  // refits whose other ways and kinds are tried

/// The search, stage by stage: each goes on only while nothing explains the recording.
class Search {
 public:
  Search(const FirstLook& look, RefitList& refits) : look_(look), refits_(refits) {}

  /// See search_refits.
  bool operator()(const std::vector<std::string>& wanted) {
    if (!wanted.empty()) {
      refit_wanted(wanted);
      return false;
    }
    refit_from_tangents();
    if (!look_.settled && refits_.move_to_better_base()) return verdict() == Verdict::unexplained;
    if (!wide()) return false;
    const bool all = look_.search == SearchDepth::all;
    if (all && !explained()) refit_other_ways();
    if (look_.search != SearchDepth::tangents && !explained()) refit_from_beginning();
    if (all && !explained()) refit_other_kinds();
    return false;
  }

 private:
  void refit_wanted(const std::vector<std::string>& wanted);
  void refit_from_tangents();
  void refit_other_ways();
  void refit_from_beginning();
  void refit_other_kinds();
  std::vector<const Candidate*> ways_as_it_begins() const;
  std::vector<Refit> leaders() const;
  /// Something is to be explained that tangents may not show. What a model that already has an effect leaves is small
  /// once it passes its test, and tangents are taken at the right place.
  bool wide() const {
    return look_.search == SearchDepth::all ? look_.given.test.discrepancy() > 0.0 : !look_.given.test.passes();
  }
  Verdict verdict() const { return judge(refits_.compare()); }
  bool explained() const { return verdict() == Verdict::missing; }
  /// Runs in full take long: none for an effect whose tangent explains next to nothing.
  bool worth_full_runs(const Ranked& r) const {
    return r.best->linear || r.score.explained > kComparison.promising * structured_squares(look_.base.rows);
  }

  const FirstLook& look_;
  RefitList& refits_;
};

void Search::refit_wanted(const std::vector<std::string>& wanted) {
  std::vector<Addition> list;
  for (const Ranked& r : look_.ranked) {
    if (std::find(wanted.begin(), wanted.end(), r.effect) != wanted.end()) list.push_back({r.best, r.score.amplitude});
  }
  refits_.add(list);
}

// Every effect where something is to be explained; else those whose tangents speak for them. The first one alone: what
// falls behind it need not be fitted to the end.
void Search::refit_from_tangents() {
  std::vector<Addition> first, others;
  for (const Ranked& r : look_.ranked) {
    if (!worth_full_runs(r) || (!wide() && r.evidence < 0.0)) continue;
    (first.empty() ? first : others).push_back({r.best, r.score.amplitude});
  }
  refits_.add(first);
  refits_.add(others);
}

// Up to so many refits, best first; copies, because the list changes while they are used.
std::vector<Refit> Search::leaders() const {
  std::vector<Refit> out;
  for (const Refit& refit : refits_.all()) {
    if (out.size() < kLeaders) out.push_back(refit);
  }
  return out;
}

// The best of the leaders' ways that look different from the one that was refitted: tangents choose badly between them.
void Search::refit_other_ways() {
  std::vector<Addition> list;
  for (const Refit& leader : leaders()) {
    const Score known = look_.scorer->score(leader.way->tangent);
    const Candidate* other = nullptr;
    Score best;
    for (const Candidate& candidate : look_.candidates) {
      if (candidate.effect != leader.effect || &candidate == leader.way) continue;
      Score score = look_.scorer->score(candidate.tangent);
      if (score.cosine_with(known) > kSameWay || !candidate.allows(score.amplitude)) continue;
      if (other != nullptr && score.log_bayes_factor <= best.log_bayes_factor) continue;
      other = &candidate;
      best = std::move(score);
    }
    if (other != nullptr) list.push_back({other, best.amplitude});
  }
  refits_.add(list);
}

// The leaders in other directions, or on other regions, from the rhythm (or what else is scanned) that they found.
void Search::refit_other_kinds() {
  std::vector<Addition> list;
  for (const Refit& leader : leaders()) {
    if (leader.way->proposal.kind_keys.empty()) continue;
    for (const Candidate& candidate : look_.candidates) {
      if (candidate.effect == leader.effect && candidate.proposal.is_other_kind_of(leader.way->proposal))
        list.push_back({&candidate, {}, leader.parameters});
    }
  }
  refits_.add(list);
}

// Where phases have drifted apart a tangent says little: what is unexplained may be any effect's, of any direction and
// strength. The best fits of the recording's beginning tell where to start.
void Search::refit_from_beginning() {
  const std::vector<const Candidate*> ways = ways_as_it_begins();
  std::vector<std::optional<BeginningFit>> fits(ways.size());
  refits_.try_each(
      ways.size(), [&](std::size_t i) { return "beginning with " + ways[i]->effect; },
      [&](std::size_t i) { fits[i] = fit_beginning(look_.base, *ways[i]); });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (fits[i]) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return fits[a]->deviance < fits[b]->deviance; });
  std::vector<Addition> list;
  std::map<std::string, std::size_t> taken;
  for (const std::size_t i : order) {
    if (list.size() < kBegun && taken[ways[i]->effect]++ < kBegunOf)
      list.push_back({ways[i], {}, fits[i]->parameters, true});
  }
  refits_.add(list);
}

// Of each effect and kind the most evident way, as the recording begins.
std::vector<const Candidate*> Search::ways_as_it_begins() const {
  const std::vector<Eigen::Index>& offsets = look_.base.rows.offsets;
  const Eigen::Index rows = offsets[static_cast<std::size_t>(kBeginning * static_cast<double>(offsets.size() - 1))];
  const Scorer scorer(look_.error.head(rows), look_.known.topRows(rows), look_.comparison.noise_variance());
  std::map<std::string, std::pair<double, const Candidate*>> best;
  for (const Candidate& candidate : look_.candidates) {
    if (!candidate.linear) continue;
    const Tangent beginning{candidate.tangent.columns.topRows(rows), candidate.tangent.prior_std};
    const double evidence = scorer.score(beginning).log_bayes_factor;
    auto& known = best[candidate.effect + " " + candidate.proposal.kind()];
    if (known.second == nullptr || evidence > known.first) known = {evidence, &candidate};
  }
  std::vector<const Candidate*> out;
  for (const auto& [kind, way] : best) out.push_back(way.second);
  return out;
}

}  // namespace

bool search_refits(const FirstLook& look, const std::vector<std::string>& wanted, RefitList& refits) {
  return Search(look, refits)(wanted);
}

}  // namespace tissue_stiffness
