#include "diagnosis/refit_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "diagnosis/initial_segment.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSameVariant = 0.8;      // cosine above which two variants are one
constexpr std::size_t kScanned = 8;       // candidates that are fitted to the initial segment where its scan ends
constexpr std::size_t kWarmStarts = 6;    // places that a stage finds and from which the whole recording is fitted
constexpr std::size_t kWarmStartsOf = 2;  // those of one effect
constexpr std::size_t kLeaders = 3;       // refits whose other variants are tried
constexpr std::size_t kVariants = 12;     // of each leader, those with most evidence in the initial segment
constexpr int kRounds = 3;                // in which they are tried
constexpr std::size_t kTogether = 2;      // nonlinear refits that are fitted side by side

/// The search goes stage by stage. Once something explains the recording, only other variants of what leads are tried.
class RefitSearch {
 public:
  RefitSearch(const Screening& screening, RefitList& refits) : screening_(screening), refits_(refits) {}

  /// See refit_effects.
  void all_in_full() {
    std::vector<RefitTask> list;
    for (const Ranked& r : screening_.ranked) {
      for (RefitTask& task : tasks_of(r)) list.push_back(std::move(task));
    }
    refits_.add(list, -no_rival);
    if (screening_.beside_another && continues()) refit_from_initial_segment();
  }

  /// See search_refits.
  bool all() {
    const bool about_run = screening_.base.recording_fit->may_be_linearised();
    about_run ? refit_in_turn() : refit_from_tangents();
    if (!screening_.settled && refits_.move_to_better_base() && !screening_.beside_another) return !explained();
    if (about_run && continues()) {
      refit_other_tangents();
      if (!explained()) refit_from_initial_segment();
    } else if (!about_run && (explained() || continues())) {
      refit_from_initial_segment();
      if (!explained() && !screening_.beside_another) refit_faint_nonlinear_effects();
    }
    return false;
  }

 private:
  void refit_from_tangents();
  void refit_in_turn();
  void refit_other_tangents();
  void refit_from_initial_segment();
  void refit_faint_nonlinear_effects();
  std::vector<const Candidate*> most_evident_initially();
  std::vector<const Refit*> leaders() const;
  std::vector<const Candidate*> others_than(const Candidate& candidate) const;

  /// A candidate may be fitted from these places, best first.
  struct Start {
    const Candidate* candidate = nullptr;
    std::vector<RankedFit> places;

    double deviance() const { return places.empty() ? no_rival : places.front().deviance; }
  };
  static std::vector<Start> best_of(std::vector<Start> starts, std::size_t most);
  std::vector<Start> scanned();
  std::vector<Start> variants_of_leaders();
  void fit(std::vector<Start>& starts);
  std::map<std::string, double> parameters_for(const Candidate& candidate, const Refit& leader) const;
  /// Returns whether more than noise and the mesh's error is to be explained. What a model that already has an effect
  /// leaves is small once it passes its test.
  bool wide() const {
    return screening_.beside_another ? !screening_.given.strict_test.passes() : screening_.given.strict_test.structured();
  }
  /// Returns whether to go beyond the tangents: something is to be explained, and a known pair is not far ahead.
  bool continues() const {
    return wide() && !explained() && (refits_.empty() || refits_.best().fitted <= kReach * screening_.rival);
  }
  /// Returns whether the tangent of a nonlinear effect explains little. Fits of such effects take long.
  bool faint(const Ranked& r) const { return !r.best().linear && !(r.score().explained > screening_.least_gain()); }
  // Returns one for each form of the effect. Tangents at different places of the model do not tell forms apart.
  static std::vector<RefitTask> tasks_of(const Ranked& r) {
    std::vector<RefitTask> out;
    for (const ScoredCandidate& form : r.forms) out.push_back({form.candidate, form.score.amplitude});
    return out;
  }
  /// Returns whether an effect is missing whatever the size of the mesh's error. What a large error alone lets pass may be
  /// a near twin of what has not been fitted yet.
  bool explained() const {
    return judge(refits_.compare()) == Verdict::missing && refits_.best().assessment.strict_test.passes();
  }
  const std::map<const Candidate*, double>& initial_evidence();

  const Screening& screening_;
  RefitList& refits_;
  std::map<const Candidate*, double> initial_evidence_;  ///< empty until it is needed
  std::map<std::string, double> explored_;  ///< leaders whose variants were tried, with what they were `fitted`
};

// Refits every effect where more than noise is left. That may be the mesh's, or of an effect whose tangent does not show it
// because E compensates for it. Elsewhere an effect's tangent has to speak for it. The first one goes alone: what falls
// behind it need not be fitted to the end.
void RefitSearch::refit_from_tangents() {
  std::vector<RefitTask> first, others;
  const bool all = !refits_.passes_without_mesh();
  for (const Ranked& r : screening_.ranked) {
    if (faint(r) || (!all && !(r.evidence > kComparison.worthwhile))) continue;
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

// Returns up to kLeaders refits, best first. They are valid until more are added.
std::vector<const Refit*> RefitSearch::leaders() const {
  std::vector<const Refit*> out;
  for (const Refit& refit : refits_.all()) {
    if (out.size() < kLeaders) out.push_back(&refit);
  }
  return out;
}

// Returns where a variant starts: where its leader fits. If they differ in a place, the leader's place is not taken over.
std::map<std::string, double> RefitSearch::parameters_for(const Candidate& candidate, const Refit& leader) const {
  if (candidate.proposal.is_other_kind_of(leader.candidate->proposal)) return leader.parameters;
  std::map<std::string, double> out;
  for (const auto& [name, value] : leader.parameters) {
    const bool added = screening_.base.recording_fit->index(name) < 0;
    if (!added || candidate.has_amplitude(name)) out[name] = value;
  }
  return out;
}

// A variant of a nonlinear model is too slow to run only to be ranked, so its tangent ranks it.
void RefitSearch::refit_other_tangents() {
  std::vector<RefitTask> list;
  for (const Refit* leader : leaders()) {
    const Score known = screening_.scorer->score(leader->candidate->tangent);
    const Candidate* other = nullptr;
    Score best;
    for (const Candidate& candidate : screening_.candidates) {
      if (candidate.effect != leader->effect || &candidate == leader->candidate) continue;
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
// strength. The best fits of the initial segment tell where to start. A leader that fits better then has its variants tried
// anew, also where another effect explains the recording: effects are compared by their best variants.
void RefitSearch::refit_from_initial_segment() {
  std::vector<Start> starts;
  if (!explained()) starts = scanned();
  for (int round = 0; round < kRounds; ++round) {
    for (Start& variant : variants_of_leaders()) starts.push_back(std::move(variant));
    if (starts.empty()) return;
    fit(starts);
    std::vector<RefitTask> list;
    for (Start& start : best_of(std::move(starts), kWarmStarts))
      list.push_back({start.candidate, {}, std::move(start.places.front().parameters)});
    refits_.add(list);
    starts.clear();
  }
}

// Scans one candidate of each effect and kind, and returns those that explain the initial segment best.
std::vector<RefitSearch::Start> RefitSearch::scanned() {
  const std::vector<const Candidate*> candidates = most_evident_initially();
  std::vector<Start> starts(candidates.size());
  refits_.try_each(
      starts.size(), [&](std::size_t i) { return "scan of the initial segment with " + candidates[i]->effect; },
      [&](std::size_t i) {
        starts[i] = {candidates[i], scan_initial_segment(screening_.base, *candidates[i], others_than(*candidates[i]))};
      });
  return best_of(std::move(starts), kScanned);
}

// Returns the candidates that differ from this one in their start alone.
std::vector<const Candidate*> RefitSearch::others_than(const Candidate& candidate) const {
  std::vector<const Candidate*> out;
  for (const Candidate& other : screening_.candidates) {
    if (&other != &candidate && other.proposal.differs_in_start_from(candidate.proposal)) out.push_back(&other);
  }
  return out;
}

// Tangents choose badly between the variants of an effect, and so do their costs where the leader fits. So each other
// variant of the leaders is fitted from there.
std::vector<RefitSearch::Start> RefitSearch::variants_of_leaders() {
  std::vector<Start> out;
  const double gain = 2.0 * kComparison.worthwhile * refits_.comparison().noise_variance();
  for (const Refit* leader : leaders()) {
    const auto known = explored_.find(leader->effect);
    if (known != explored_.end() && leader->fitted > known->second - gain) continue;
    explored_[leader->effect] = leader->fitted;
    std::vector<std::pair<double, const Candidate*>> variants;
    for (const auto& [candidate, evidence] : initial_evidence()) {
      if (candidate->effect == leader->effect && candidate != leader->candidate) variants.emplace_back(evidence, candidate);
    }
    std::sort(variants.begin(), variants.end(), std::greater<>());
    variants.resize(std::min(variants.size(), kVariants));
    for (const auto& [evidence, candidate] : variants) out.push_back({candidate, {{parameters_for(*candidate, *leader)}}});
  }
  return out;
}

// Fits each start's candidate to the initial segment. What falls behind the best scan is not fitted to the end.
void RefitSearch::fit(std::vector<Start>& starts) {
  double rival = no_rival;
  for (const Start& start : starts) rival = std::min(rival, start.deviance());
  refits_.try_each(
      starts.size(), [&](std::size_t i) { return "initial segment with " + starts[i].candidate->effect; },
      [&](std::size_t i) {
        std::vector<std::map<std::string, double>> from;
        for (RankedFit& place : starts[i].places) from.push_back(std::move(place.parameters));
        starts[i].places.clear();
        starts[i].places.push_back(fit_initial_segment(screening_.base, *starts[i].candidate, from, rival));
      });
}

// Returns the best starts, of which at most kWarmStartsOf are of one effect.
std::vector<RefitSearch::Start> RefitSearch::best_of(std::vector<Start> starts, std::size_t most) {
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.deviance() < b.deviance(); });
  std::vector<Start> out;
  std::map<std::string, std::size_t> taken;
  for (Start& start : starts) {
    if (std::isfinite(start.deviance()) && out.size() < most && taken[start.candidate->effect]++ < kWarmStartsOf)
      out.push_back(std::move(start));
  }
  return out;
}

// Returns the evidence of each linear candidate's tangent in the initial segment.
const std::map<const Candidate*, double>& RefitSearch::initial_evidence() {
  if (!initial_evidence_.empty()) return initial_evidence_;
  const FrameRows& frames = screening_.base.rows.frames;
  const Eigen::Index rows = frames.before(static_cast<Eigen::Index>(kInitialSegment * static_cast<double>(frames.count())));
  const Scorer scorer(screening_.error.head(rows), screening_.nuisance_tangents.topRows(rows),
                      screening_.comparison.noise_variance());
  for (const Candidate& candidate : screening_.candidates) {
    if (!candidate.linear) continue;
    const Tangent initial{candidate.tangent.columns.topRows(rows), candidate.tangent.prior_std};
    initial_evidence_[&candidate] = scorer.score(initial).log_bayes_factor;
  }
  return initial_evidence_;
}

// Returns for each effect and kind the candidate with most evidence in the initial segment.
std::vector<const Candidate*> RefitSearch::most_evident_initially() {
  std::map<std::string, std::pair<double, const Candidate*>> best;
  for (const auto& [candidate, evidence] : initial_evidence()) {
    auto& known = best[candidate->effect + " " + candidate->proposal.kind()];
    if (known.second == nullptr || evidence > known.first) known = {evidence, candidate};
  }
  std::vector<const Candidate*> out;
  out.reserve(best.size());
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
