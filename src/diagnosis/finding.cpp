#include "tissue_stiffness/diagnosis/finding.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kRefits = 6;      // candidates that are simulated anew
constexpr std::ptrdiff_t kWaysOf = 3;   // leading effects that are refitted in two ways
constexpr double kSameWay = 0.8;        // cosine above which two ways are one
constexpr std::size_t kMostWays = 3;    // of an effect and kind that are refitted where nothing explains
constexpr std::size_t kBegun = 6;       // fits of the beginning that are tried on the whole recording
constexpr std::size_t kBegunOf = 2;     // of one effect
constexpr std::size_t kKindsOf = 2;     // leading refits whose other kinds are tried
constexpr std::size_t kOthers = 4;      // and more, when those leave more than noise
constexpr std::size_t kPairs = 3;       // and pairs
constexpr double kRemainder = 0.25;     // of the mesh's error that a mesh twice as fine still has, or more
constexpr double kTwin = 0.9;           // cosine above which two effects look alike
constexpr double kSameEvidence = 5.0;   // log evidence within which refits are not told apart
constexpr double kAdequate = 1.1;       // rms in sigmas up to which a residual may be noise
constexpr double kExplained = 1.02;     // and up to which a refit need not be bettered
constexpr double kPromise = 0.2;        // of the structured part
constexpr double kExplains = 0.8;       // of the structured part: less is no explanation
constexpr double kHeldOutGain = 0.995;  // of the held-out rms: what an accepted effect must fall below

// Evidence of a refit after Schwarz, errors counted as large as the best refit leaves them.
double evidence(const Refit& refit, double rows, double variance) {
  return -0.5 * refit.cost / variance - 0.5 * refit.added_parameters * std::log(rows);
}

/// One look, step by step.
class Look {
 public:
  Look(const Fitted& base, const DiagnosisOptions& options, Eigen::VectorXd by_mesh)
      : base_(base),
        options_(options),
        rows_(base.rows.count()),
        cost_(base.rows.error.squaredNorm()),
        mesh_change_(std::move(by_mesh)) {
    options.progress("tangents of the library, and what a finer mesh would change", 0, 0);
    const Eigen::VectorXd std = base.fit.covariance.diagonal().cwiseSqrt();
    Eigen::MatrixXd known;
    tbb::parallel_invoke(
        [&] {
          candidates_ = find_candidates(*base.study, base.fit.w, options.ignore);
          known = base_tangents(*base.study, base.fit.w, std, base.rows);
        },
        [&] {
          if (mesh_change_.size() == 0) mesh_change_ = finer_mesh(base);
        });
    by_mesh_ = cost_ - (base.rows.error - mesh_change_).squaredNorm();
    floor_ = Scorer(base.rows.error, known, base.rows.offsets, 1.0).remaining(mesh_change_);
    // An effect has to explain what the mesh does not.
    scorer_ = std::make_unique<Scorer>(base.rows.error - mesh_change_, known, base.rows.offsets, 1.0);
    ranked_ = rank(*scorer_, candidates_, kRemainder * floor_);
    known_ = std::move(known);
  }

  Finding find(const std::vector<std::string>& wanted) {
    require_proposed(wanted);
    refit_singles(wanted);
    const bool by_effect = wanted.empty() && !noise() && by_mesh_ < kExplains * structured();
    if (by_effect && leaves_more_than_noise()) refit_others();
    if (by_effect && leaves_more_than_noise()) refit_other_kinds();
    if (by_effect && leaves_more_than_noise()) refit_rest();
    if (by_effect && leaves_more_than_noise() && !explained()) refit_from_beginning();
    if (by_effect && leaves_more_than_noise() && !explained()) refit_pairs();
    Finding out;
    out.verdict = judge();
    out.floor = floor_;
    out.by_mesh = mesh_change_;
    if (out.verdict == "missing" || out.verdict == "unexplained") out.set = set();
    describe_all(out.effects);
    out.refits = refits_;
    return out;
  }

 private:
  void require_proposed(const std::vector<std::string>& wanted) const;
  void refit_singles(const std::vector<std::string>& wanted);
  void refit_others();
  void refit_other_kinds();
  void add_other_way(const Ranked& r, std::vector<std::vector<Addition>>& list) const;
  void drop_worse_ways();
  void refit_rest();
  void refit_from_beginning();
  std::vector<const Candidate*> different_ways() const;
  void refit_pairs();
  bool refitted(const std::string& effect) const {
    return std::any_of(refits_.begin(), refits_.end(), [&](const Refit& r) { return r.effects.front() == effect; });
  }
  /// Runs in full take long: none for an effect whose tangent explains next to nothing.
  bool worth_full_runs(const Ranked& r) const {
    return r.best->linear || r.score.explained * cost_ > kPromise * structured();
  }
  void refit_all(const std::vector<std::vector<Addition>>& list);
  void try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                const std::function<void(std::size_t)>& work) const;
  void sort_refits();
  std::string judge() const;
  std::vector<std::string> set() const;
  void describe_all(std::vector<MissingEffect>& out) const;
  MissingEffect describe(const Ranked& r) const;
  /// Sum of squares that is no more than noise and what the mesh itself does.
  double unavoidable() const { return (1.0 + floor_ * floor_) * rows_; }
  bool leaves_more_than_noise() const {
    return refits_.empty() || refits_.front().cost > kExplained * kExplained * unavoidable();
  }
  bool noise() const { return cost_ < kAdequate * kAdequate * rows_; }
  bool explained() const {
    if (refits_.empty()) return false;
    const double left = refits_.front().cost - rows_;
    return left < (1.0 - kExplains) * structured() || left < floor_ * floor_ * rows_;
  }
  double structured() const { return std::max(0.0, cost_ - rows_); }

  const Fitted& base_;
  const DiagnosisOptions& options_;
  const double rows_, cost_;
  std::vector<Candidate> candidates_;
  Eigen::MatrixXd known_;  ///< tangents of the base's parameters
  std::unique_ptr<Scorer> scorer_;
  Eigen::VectorXd mesh_change_;  ///< of each row, by a finer mesh [sigma]
  double floor_ = 0.0;
  double by_mesh_ = 0.0;  ///< of the sum of squared errors
  std::vector<Ranked> ranked_;
  std::vector<Refit> refits_;
};

void Look::require_proposed(const std::vector<std::string>& wanted) const {
  for (const std::string& effect : wanted) {
    if (std::none_of(ranked_.begin(), ranked_.end(), [&](const Ranked& r) { return r.effect == effect; })) {
      throw InputError("--add", effect, "an effect that the library proposes for this model");
    }
  }
}

std::string names_of(const std::vector<Addition>& additions) {
  std::string names;
  for (const Addition& a : additions) names += (names.empty() ? "" : " and ") + a.way->effect;
  return names;
}

// Each on a core of its own; what a model that cannot be run would find is left out.
void Look::try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                    const std::function<void(std::size_t)>& work) const {
  std::mutex telling;
  std::size_t over = 0;
  const auto try_one = [&](std::size_t i) {
    {
      const std::lock_guard<std::mutex> lock(telling);
      options_.progress(name(i), over, count);
    }
    try {
      work(i);
    } catch (const NumericalError&) {
      base_.study->recording().checkpoint();  // a study that was ended; else a model that cannot be run explains nothing
    }
    const std::lock_guard<std::mutex> lock(telling);
    ++over;
  };
  tbb::parallel_for(std::size_t{0}, count, try_one, tbb::simple_partitioner());
}

void Look::refit_all(const std::vector<std::vector<Addition>>& list) {
  std::vector<std::optional<Refit>> done(list.size());
  try_each(
      list.size(), [&](std::size_t i) { return "refit with " + names_of(list[i]); },
      [&](std::size_t i) { done[i] = refit(base_, list[i]); });
  for (std::optional<Refit>& refit : done) {
    if (refit) refits_.push_back(std::move(*refit));
  }
  sort_refits();
  for (std::size_t i = 1; i < refits_.size(); ++i) refits_[i].model.reset();
}

void Look::refit_singles(const std::vector<std::string>& wanted) {
  std::vector<std::vector<Addition>> list;
  for (const Ranked& r : ranked_) {
    const bool asked = std::find(wanted.begin(), wanted.end(), r.effect) != wanted.end();
    if (!asked && (!r.declared || !worth_full_runs(r) || list.size() >= kRefits || !wanted.empty())) continue;
    list.push_back({{r.best, r.score.amplitude}});
  }
  refit_all(list);
}

// What correlated errors could have made as well; and other ways of the leading effects.
void Look::refit_others() {
  std::vector<std::vector<Addition>> list;
  std::size_t others = 0;
  for (const Ranked& r : ranked_) {
    if (&r - ranked_.data() < kWaysOf && r.promising) add_other_way(r, list);
    if (r.promising && !r.declared && worth_full_runs(r) && others++ < kOthers)
      list.push_back({{r.best, r.score.amplitude}});
  }
  refit_all(list);
}

// Of the leading effects also the best of the ways that look different: tangents choose badly between directions.
void Look::add_other_way(const Ranked& r, std::vector<std::vector<Addition>>& list) const {
  const Candidate* other = nullptr;
  Score best;
  for (const Candidate& candidate : candidates_) {
    if (candidate.effect != r.effect || &candidate == r.best) continue;
    Score score = scorer_->score(candidate.tangent);
    if (score.cosine_with(r.score) > kSameWay || !candidate.allows(score.amplitude)) continue;
    if (other != nullptr && score.log_bayes_factor <= best.log_bayes_factor) continue;
    other = &candidate;
    best = std::move(score);
  }
  if (other != nullptr && best.log_bayes_factor > kSameEvidence) list.push_back({{other, best.amplitude}});
}

// The leading refits in other directions, or on other regions, from the rhythm (or what else is scanned) that they found.
void Look::refit_other_kinds() {
  std::vector<std::vector<Addition>> list;
  for (std::size_t i = 0; i < std::min(kKindsOf, refits_.size()); ++i) {
    const Refit& leader = refits_[i];
    if (leader.effects.size() > 1 || leader.way->proposal.kind.empty()) continue;
    for (const Candidate& candidate : candidates_) {
      if (candidate.effect == leader.way->effect && candidate.proposal.is_other_kind_of(leader.way->proposal)) {
        list.push_back({{&candidate, {}, leader.parameters}});
      }
    }
  }
  refit_all(list);
}

// One refit an effect, the best.
void Look::drop_worse_ways() {
  for (auto refit = refits_.begin(); refit != refits_.end();) {
    const bool known = std::any_of(refits_.begin(), refit, [&](const Refit& r) { return r.effects == refit->effects; });
    refit = known ? refits_.erase(refit) : refit + 1;
  }
}

// What tangents at the end leave may still be a single effect's.
void Look::refit_rest() {
  std::vector<std::vector<Addition>> list;
  for (const Ranked& r : ranked_) {
    if (r.best->linear && r.evidence > kSameEvidence && !refitted(r.effect)) list.push_back({{r.best, r.score.amplitude}});
  }
  refit_all(list);
}

// Where phases have drifted apart a tangent says little: what is unexplained may be any effect's, of any direction and
// strength. The best fits of the recording's beginning tell where to start.
void Look::refit_from_beginning() {
  const std::vector<const Candidate*> ways = different_ways();
  std::vector<std::optional<BeginningFit>> fits(ways.size());
  try_each(
      ways.size(), [&](std::size_t i) { return "beginning with " + ways[i]->effect; },
      [&](std::size_t i) { fits[i] = fit_beginning(base_, *ways[i]); });
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
  refit_all(list);
}

// Of each effect and kind the most evident ways that look different from one another, as the recording begins.
std::vector<const Candidate*> Look::different_ways() const {
  std::vector<Eigen::Index> offsets = base_.rows.offsets;
  offsets.resize(1 + static_cast<std::size_t>(kBeginning * static_cast<double>(offsets.size() - 1)));
  const Eigen::Index rows = offsets.back();
  const Scorer scorer((base_.rows.error - mesh_change_).head(rows), known_.topRows(rows), offsets, 1.0);
  std::vector<std::pair<const Candidate*, Score>> ways;
  for (const Candidate& candidate : candidates_) {
    if (!candidate.linear) continue;
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

void Look::refit_pairs() {
  std::vector<std::vector<Addition>> list;
  std::set<std::string> alone;
  std::size_t done = 0;
  for (const RankedPair& pair : rank_pairs(*scorer_, candidates_)) {
    if (done++ == kPairs) break;
    if (pair.gain < kSameEvidence || !pair.first.way->linear || !pair.second.way->linear) continue;
    for (const Addition* member : {&pair.first, &pair.second}) {  // a pair has to beat its better half
      const std::string& effect = member->way->effect;
      if (!refitted(effect) && alone.insert(effect).second) list.push_back({*member});
    }
    list.push_back({pair.first, pair.second});
  }
  refit_all(list);
}

void Look::sort_refits() {
  double lowest = cost_;
  for (const Refit& r : refits_) lowest = std::min(lowest, r.cost);
  const double variance = std::max(1.0, lowest / rows_);
  std::stable_sort(refits_.begin(), refits_.end(), [&](const Refit& a, const Refit& b) {
    return evidence(a, rows_, variance) > evidence(b, rows_, variance);
  });
  drop_worse_ways();
}

std::string Look::judge() const {
  // An effect has to explain more than the mesh's error, which another mesh would change.
  const bool gained =
      !refits_.empty() && proven(base_, refits_.front()) && cost_ - refits_.front().cost > floor_ * floor_ * rows_;
  // Within the noise, what the mesh explains about as well is no sign of an effect.
  if (noise() && (!gained || by_mesh_ > 0.5 * (cost_ - refits_.front().cost))) return "adequate";
  if (by_mesh_ > kExplains * structured()) return "numerics";
  if (!gained) return "unexplained";
  return explained() ? "missing" : "unexplained";
}

std::vector<std::string> Look::set() const {
  std::vector<std::string> set;
  if (refits_.empty()) return set;
  const double variance = std::max(1.0, refits_.front().cost / rows_);
  const double best = evidence(refits_.front(), rows_, variance);
  const double by_a_finer_mesh = kRemainder * floor_ * floor_ * rows_;
  for (const Refit& r : refits_) {
    const bool larger = r.effects.size() > refits_.front().effects.size();
    const bool alike =
        best - evidence(r, rows_, variance) < kSameEvidence || r.cost - refits_.front().cost < by_a_finer_mesh;
    if (larger || !alike) continue;
    for (const std::string& effect : r.effects) {
      if (std::find(set.begin(), set.end(), effect) == set.end()) set.push_back(effect);
    }
  }
  return set;
}

MissingEffect Look::describe(const Ranked& r) const {
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
  out.held_out_rms_before = rms_error(base_.rows, base_.study->recording(), true);
  for (const std::size_t size : {2, 1}) {  // its own refit says more of it than a pair's
    const auto refit = std::find_if(refits_.begin(), refits_.end(), [&](const Refit& known) {
      return known.effects.size() == size && std::count(known.effects.begin(), known.effects.end(), r.effect) > 0;
    });
    if (refit == refits_.end()) continue;
    const auto at = std::find(refit->effects.begin(), refit->effects.end(), r.effect) - refit->effects.begin();
    out.parameters = refit->parameters;
    out.held_out_rms_after = refit->held_out_rms;
    out.explained = 1.0 - refit->cost / cost_;
    out.entry = refit->entries[static_cast<std::size_t>(at)];
  }
  for (const Ranked& other : ranked_) {
    if (other.effect == r.effect) continue;
    const double cosine = r.score.cosine_with(other.score);
    if (cosine > kTwin) out.confusable_with.push_back({other.effect, cosine});
  }
  return out;
}

// Refitted ones first, in the order of their refits; then the others, by the tangents' evidence.
void Look::describe_all(std::vector<MissingEffect>& out) const {
  std::vector<std::string> order;
  for (const Refit& refit : refits_) order.insert(order.end(), refit.effects.begin(), refit.effects.end());
  for (const Ranked& r : ranked_) order.push_back(r.effect);
  for (const std::string& effect : order) {
    if (std::any_of(out.begin(), out.end(), [&](const MissingEffect& known) { return known.effect == effect; })) continue;
    out.push_back(
        describe(*std::find_if(ranked_.begin(), ranked_.end(), [&](const Ranked& r) { return r.effect == effect; })));
  }
}

}  // namespace

bool proven(const Fitted& base, const Refit& refit) {
  return refit.held_out_sigmas < kHeldOutGain * rms_sigmas(base.rows, base.study->recording(), true);
}

Finding look(const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
             const Eigen::VectorXd& by_mesh) {
  return Look(base, options, by_mesh).find(wanted);
}

}  // namespace tissue_stiffness
