#include "tissue_stiffness/diagnosis/refit_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kRefits = 6;     // candidates that are simulated anew
constexpr std::ptrdiff_t kWaysOf = 3;  // leading effects that are refitted in two ways
constexpr double kSameWay = 0.8;       // cosine above which two ways are one
constexpr std::size_t kMostWays = 3;   // of an effect and kind that are refitted where nothing explains
constexpr std::size_t kBegun = 6;      // fits of the beginning that are tried on the whole recording
constexpr std::size_t kBegunOf = 2;    // of one effect
constexpr std::size_t kKindsOf = 2;    // leading refits whose other kinds are tried
constexpr std::size_t kOthers = 4;     // and more, when those leave more than noise
constexpr std::size_t kPairs = 3;      // and pairs
constexpr double kPromise = 0.2;       // of the structured part
constexpr double kClean = 1.1;         // rms in sigmas that a refit with no rival leaves
constexpr double kSeen = 0.5;          // of what a refit explains: a tangent that sees less is none
constexpr double kFaithful = 0.9;      // and one that sees as much tells what others would explain
constexpr double kVisible = 0.02;      // of the noise's sum of squares: more than a slightly wrong one
constexpr double kChance = 3.0;        // standard deviations of that sum
constexpr std::ptrdiff_t kSimple = 2;  // parameters of what is fitted to the beginning where the error may be noise
constexpr double kRival = 0.5;         // of a leader's evidence by tangents: less is no rival

/// The search, stage by stage.
class Search {
 public:
  Search(const FirstLook& look, const DiagnosisOptions& options, const RefitsSoFar& so_far)
      : look_(look), refits_(look, options, so_far) {}

  std::vector<Refit> operator()(const std::vector<std::string>& wanted) {
    refit_singles(wanted);
    if (!wanted.empty() || look_.numerics()) return refits_.take();
    refits_.compare_beside_steps();
    if (look_.noise() && !puzzles()) return refits_.take();
    if (unsettled() || (faint() && look_.first)) refit_others();  // the first look's set is told
    if (unsettled()) refit_other_kinds();
    if (unsettled()) refit_rest();
    if ((unsettled() && !refits_.explains()) || tangents_mislead() || quiet()) refit_from_beginning();
    if (refits_.leaves_more_than_noise() && !refits_.explains()) refit_pairs();
    refits_.compare_beside_steps();
    refits_.compare_on_finer_mesh();
    return refits_.take();
  }

 private:
  void refit_singles(const std::vector<std::string>& wanted);
  void refit_others();
  void refit_other_kinds();
  void refit_rest();
  void refit_from_beginning();
  void refit_pairs();
  void add_other_way(const Ranked& r, std::vector<std::vector<Addition>>& list) const;
  std::vector<const Candidate*> different_ways() const;
  /// Runs in full take long: none for an effect whose tangent explains next to nothing.
  bool worth_full_runs(const Ranked& r) const {
    return r.best->linear || r.score.explained * look_.cost > kPromise * look_.structured();
  }
  /// An error that may be noise is more than that, as far as the recording's own time steps are not to blame, and nothing
  /// explains it.
  bool puzzles();
  bool unsettled() { return refits_.leaves_more_than_noise() || puzzles(); }
  /// The best refit explains what its tangent did not see, and not all of it: its twins may not have been seen either.
  bool tangents_mislead() const;
  /// Smaller than the noise, several effects may explain the error, and others than were declared: the modulus has taken
  /// most of it, and the tangents were taken there.
  bool faint() const { return look_.structured() < look_.rows; }
  /// All the more, where the mesh's error is much beside it.
  bool quiet() const { return !refits_.empty() && refits_.mesh_counts() && faint(); }
  /// Share of what the best refit explains that its tangent saw, too.
  double seen_of_best() const;
  /// Not where the best refit explains the error, as its tangent said, and the tangents of all that this effect would be
  /// fitted by see far less of it.
  bool may_win(const Ranked& r) const;
  const Ranked& ranked(const std::string& effect) const {
    return *std::find_if(look_.ranked.begin(), look_.ranked.end(), [&](const Ranked& r) { return r.effect == effect; });
  }

  const FirstLook& look_;
  RefitList refits_;
};

bool Search::tangents_mislead() const {
  if (refits_.empty() || refits_.best().cost_beside_steps < kClean * kClean * look_.rows) return false;
  return seen_of_best() < kSeen;
}

bool Search::puzzles() {
  const bool slow = look_.base.study->model().nonlinear();  // every fit more takes full runs
  if (!look_.noise() || slow || refits_.explains()) return false;
  const double visible = std::max(kVisible, kChance * std::sqrt(2.0 / look_.rows));
  const auto is_more = [&](double cost) { return cost > look_.unavoidable() + visible * look_.rows; };
  return is_more(look_.cost) && is_more(refits_.left_beside_steps());
}

double Search::seen_of_best() const {
  const Refit& best = refits_.best();
  return ranked(best.effects.front()).score.explained * look_.cost / (look_.cost - best.cost);
}

bool Search::may_win(const Ranked& r) const {
  if (!refits_.explains() || faint() || seen_of_best() < kFaithful) return true;
  const bool scanned = parameters_of({{r.best, {}}}) > r.score.amplitude.size();  // a better place may be in between
  return scanned || r.evidence > kRival * ranked(refits_.best().effects.front()).evidence;
}

void Search::refit_singles(const std::vector<std::string>& wanted) {
  const bool told = !look_.first && wanted.empty();
  std::vector<std::vector<Addition>> leaders, others;
  for (const Ranked& r : look_.ranked) {
    const bool asked = std::find(wanted.begin(), wanted.end(), r.effect) != wanted.end();
    const bool of_simulation = told && r.best->of_simulation && r.evidence > kSameEvidence;
    if (!asked && !of_simulation &&
        (!r.declared || !worth_full_runs(r) || leaders.size() + others.size() >= kRefits || !wanted.empty()))
      continue;
    // Once the set is told, what leaves only noise need not be compared with what sees far less.
    const bool leads = look_.first || asked || of_simulation || r.evidence > kRival * look_.ranked.front().evidence;
    (leads ? leaders : others).push_back({{r.best, r.score.amplitude}});
  }
  auto next = leaders.begin();
  if (told) {  // the recording's own time steps, then the simplest: where they leave only noise, nothing else is needed
    const auto effort = [](const auto& a) { return a.front().way->of_simulation ? 0 : parameters_of(a); };
    const auto simpler = [&](const auto& a, const auto& b) { return effort(a) < effort(b); };
    std::stable_sort(leaders.begin(), leaders.end(), simpler);
    while (next != leaders.end() && !simpler(leaders.front(), *next)) ++next;
  } else if (!leaders.empty()) {  // the first alone: what falls behind it need not be fitted to the end
    ++next;
  }
  refits_.add({leaders.begin(), next});
  if (!told || refits_.leaves_more_than_noise()) refits_.add({next, leaders.end()});
  if (refits_.leaves_more_than_noise()) refits_.add(others);
}

// What correlated errors, too, could have made; and other ways of the leading effects.
void Search::refit_others() {
  std::vector<std::vector<Addition>> list;
  std::size_t others = 0;
  for (const Ranked& r : look_.ranked) {
    if (&r - look_.ranked.data() < kWaysOf && r.promising) add_other_way(r, list);
    if (r.promising && !r.declared && worth_full_runs(r) && others++ < kOthers && may_win(r))
      list.push_back({{r.best, r.score.amplitude}});
  }
  refits_.add(list);
}

// Of the leading effects also the best of the ways that look different: tangents choose badly between directions.
void Search::add_other_way(const Ranked& r, std::vector<std::vector<Addition>>& list) const {
  const Candidate* other = nullptr;
  Score best;
  for (const Candidate& candidate : look_.candidates) {
    if (candidate.effect != r.effect || &candidate == r.best) continue;
    Score score = look_.scorer->score(candidate.tangent);
    if (score.cosine_with(r.score) > kSameWay || !candidate.allows(score.amplitude)) continue;
    if (other != nullptr && score.log_bayes_factor <= best.log_bayes_factor) continue;
    other = &candidate;
    best = std::move(score);
  }
  if (other != nullptr && best.log_bayes_factor > kSameEvidence) list.push_back({{other, best.amplitude}});
}

// The leading refits in other directions, or on other regions, from the rhythm (or what else is scanned) that they found.
void Search::refit_other_kinds() {
  std::vector<std::vector<Addition>> list;
  for (std::size_t i = 0; i < std::min(kKindsOf, refits_.all().size()); ++i) {
    const Refit& leader = refits_.all()[i];
    if (leader.effects.size() > 1 || leader.way->proposal.kind.empty()) continue;
    for (const Candidate& candidate : look_.candidates) {
      if (candidate.effect == leader.way->effect && candidate.proposal.is_other_kind_of(leader.way->proposal)) {
        list.push_back({{&candidate, {}, leader.parameters}});
      }
    }
  }
  refits_.add(list);
}

// What tangents at the end leave may still be a single effect's.
void Search::refit_rest() {
  std::vector<std::vector<Addition>> list;
  for (const Ranked& r : look_.ranked) {
    if (r.best->linear && r.evidence > kSameEvidence && !refits_.holds(r.effect) && may_win(r))
      list.push_back({{r.best, r.score.amplitude}});
  }
  refits_.add(list);
}

// Where phases have drifted apart a tangent says little: what is unexplained may be any effect's, of any direction and
// strength. The best fits of the recording's beginning tell where to start.
void Search::refit_from_beginning() {
  const std::vector<const Candidate*> ways = different_ways();
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
  std::vector<std::vector<Addition>> list;
  std::map<std::string, std::size_t> taken;
  for (const std::size_t i : order) {
    if (list.size() < kBegun && taken[ways[i]->effect]++ < kBegunOf)
      list.push_back({{ways[i], {}, fits[i]->parameters, true}});
  }
  refits_.add(list);
}

// Of each effect and kind the most evident ways that look different from one another, as the recording begins.
std::vector<const Candidate*> Search::different_ways() const {
  std::vector<Eigen::Index> offsets = look_.base.rows.offsets;
  offsets.resize(1 + static_cast<std::size_t>(kBeginning * static_cast<double>(offsets.size() - 1)));
  const Eigen::Index rows = offsets.back();
  const Scorer scorer((look_.base.rows.error - look_.finer.change).head(rows), look_.known.topRows(rows), offsets, 1.0);
  std::vector<std::pair<const Candidate*, Score>> ways;
  for (const Candidate& candidate : look_.candidates) {
    if (!candidate.linear || (look_.noise() && parameters_of({{&candidate, {}}}) > kSimple)) continue;
    const Tangent beginning{candidate.tangent.columns.topRows(rows), candidate.tangent.prior_std};
    ways.emplace_back(&candidate, scorer.score(beginning));
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](const auto& a, const auto& b) { return a.second.log_bayes_factor > b.second.log_bayes_factor; });
  std::vector<const Candidate*> out;
  std::map<std::string, std::vector<const Score*>> kept;
  for (const auto& [way, score] : ways) {
    std::vector<const Score*>& like = kept[way->effect + " " + way->proposal.kind];
    const bool known =
        std::any_of(like.begin(), like.end(), [&, &now = score](const Score* s) { return now.cosine_with(*s) > kSameWay; });
    if (known || like.size() == kMostWays) continue;
    like.push_back(&score);
    out.push_back(way);
  }
  return out;
}

void Search::refit_pairs() {
  std::vector<std::vector<Addition>> list;
  std::set<std::string> alone;
  std::size_t done = 0;
  for (const RankedPair& pair : rank_pairs(*look_.scorer, look_.candidates)) {
    if (done++ == kPairs) break;
    if (pair.gain < kSameEvidence || !pair.first.way->linear || !pair.second.way->linear) continue;
    for (const Addition* member : {&pair.first, &pair.second}) {  // a pair has to beat its better half
      const std::string& effect = member->way->effect;
      if (!refits_.holds(effect) && alone.insert(effect).second) list.push_back({*member});
    }
    list.push_back({pair.first, pair.second});
  }
  refits_.add(list);
}

}  // namespace

std::vector<Refit> search_refits(const FirstLook& look, const std::vector<std::string>& wanted,
                                 const DiagnosisOptions& options, const RefitsSoFar& so_far) {
  return Search(look, options, so_far)(wanted);
}

}  // namespace tissue_stiffness
