#include "diagnosis/pair_search.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/rounds.hpp"
#include "diagnosis/try_run.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kLeaders = 2;  // refits that are tried as one of several effects

class PairSearch {
 public:
  PairSearch(const FittedModel& model, Finding& finding, const Recording& recording, const DiagnosisOptions& options)
      : model_(model), finding_(finding), recording_(recording), options_(options) {}

  // Takes each leader in turn that explains a part of the error for one of several effects.
  std::optional<Finding> run() {
    const double cost = model_.rows.error.squaredNorm(), structured = structured_squares(model_.rows);
    std::vector<Leader> leaders;
    for (std::size_t i = 0; i < std::min(kLeaders, finding_.refits.size()) && finding_.verdict != Verdict::missing; ++i) {
      if (cost - finding_.refits[i].cost > kComparison.promising * structured)
        examine_beside(finding_.refits[i], {}, leaders);
    }
    if (finding_.verdict != Verdict::missing) turn(leaders);
    if (finding_.verdict != Verdict::missing) return std::nullopt;
    exchange(leaders);
    if (finding_.verdict != Verdict::missing) return std::nullopt;  // the likelihood of all rounds believes another model
    const std::string best = finding_.comparison.best().effects.front();
    finding_.put_first(best);
    const auto is_best = [&best](const Leader& l) { return l.effect == best; };
    const auto leader = std::find_if(leaders.begin(), leaders.end(), is_best);
    if (leader == leaders.end()) return std::nullopt;  // one effect suffices with the noise that is known now
    finding_.take_over(best, leader->deeper.effects);
    finding_.believe(Comparison(finding_.comparison));
    leader->deeper.judge_by(finding_.models);
    return std::move(leader->deeper);
  }

 private:
  /// A leader is a refit that is taken for one of several missing effects, with what is found beside it.
  struct Leader {
    std::string effect;
    Finding deeper;

    /// Returns what its best pair was fitted with.
    double cost() const { return deeper.refits.empty() ? no_rival : deeper.refits.front().fitted; }
  };
  static double best_cost(const std::vector<Leader>& leaders) {
    double best = no_rival;
    for (const Leader& leader : leaders) best = std::min(best, leader.cost());
    return best;
  }

  // The leader of a pair was fitted while the other effect was missing, which may have led it astray. So the pair that fits
  // best is fitted the other way round: all variants of its leader are tried beside the other effect, unless that one led,
  // too.
  void turn(std::vector<Leader>& leaders) {
    const auto best = std::min_element(leaders.begin(), leaders.end(),
                                       [](const Leader& a, const Leader& b) { return a.cost() < b.cost(); });
    if (best == leaders.end() || best->deeper.refits.empty()) return;
    lead_in_turn(best->deeper.refits.front(), {best->effect}, leaders);
  }

  // What else may be missing hides the difference between effects. So all of them are tried in the place of the best pair's
  // leader, beside its other effect, unless that one led, too.
  void exchange(std::vector<Leader>& leaders) {
    const std::vector<std::string> pair = finding_.comparison.best().effects;
    const auto is = [](const std::string& name) { return [name](const auto& x) { return x.effect == name; }; };
    if (pair.size() < 2) return;
    const Leader& first = *std::find_if(leaders.begin(), leaders.end(), is(pair[0]));
    if (const Refit* const second = refit_of(first.deeper, pair[1])) lead_in_turn(*second, {}, leaders);
  }

  // Lets the second effect of a pair lead, as it was fitted beside the first one, unless it led already.
  void lead_in_turn(const Refit& second, const std::vector<std::string>& wanted, std::vector<Leader>& leaders) {
    const auto is_second = [&](const Leader& l) { return l.effect == second.effect; };
    Refit* const refit = refit_of(finding_, second.effect);
    if (refit == nullptr || std::any_of(leaders.begin(), leaders.end(), is_second)) return;
    refit->proposed = second.proposed;
    refit->entry = second.entry;
    refit->parameters = second.parameters;
    refit->model.reset();
    examine_beside(*refit, wanted, leaders);
  }

  // Compares what is missing beside a leader, or how the `wanted` effects fit beside it, with all that is known.
  void examine_beside(Refit& leader, const std::vector<std::string>& wanted, std::vector<Leader>& leaders) {
    options_.progress("what is missing beside " + leader.effect, 0, 0);
    std::shared_ptr<FittedModel> next;
    Finding deeper;
    const auto examine_rest = [&] {
      next = std::make_shared<FittedModel>(extended(model_, leader));
      PreviousRound previous = after_adding(finding_, library_for(model_, *next, finding_));
      previous.rival = best_cost(leaders);
      bool moved = false;
      deeper =
          wanted.empty() ? examine(*next, options_, previous, moved) : diagnose_once(*next, wanted, options_, previous);
    };
    if (!try_run(recording_, examine_rest)) return;
    leader.model = next;
    finding_.models = std::make_shared<const ModelComparison>(common_likelihood(*finding_.models, *deeper.models));
    Comparison all = finding_.comparison;
    all.merge({leader.effect}, deeper.comparison);
    all.assess(*finding_.models);
    finding_.believe(std::move(all));
    leaders.push_back({leader.effect, std::move(deeper)});
  }

  const FittedModel& model_;
  Finding& finding_;
  const Recording& recording_;
  const DiagnosisOptions& options_;
};

}  // namespace

std::optional<Finding> search_pairs(const FittedModel& model, Finding& finding, const Recording& recording,
                                    const DiagnosisOptions& options) {
  return PairSearch(model, finding, recording, options).run();
}

}  // namespace tissue_stiffness
