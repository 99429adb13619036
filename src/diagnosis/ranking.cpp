#include "diagnosis/ranking.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kImpossible = -1e3;  // log Bayes factor of an amplitude out of bounds

bool better(const ScoredCandidate& a, const ScoredCandidate& b) {
  return a.score.log_bayes_factor > b.score.log_bayes_factor;
}

void keep_best_of_form(ScoredCandidate next, std::vector<ScoredCandidate>& forms) {
  const std::string form = next.candidate->proposal.form();
  const auto known = std::find_if(forms.begin(), forms.end(),
                                  [&form](const ScoredCandidate& s) { return s.candidate->proposal.form() == form; });
  if (known == forms.end()) {
    forms.push_back(std::move(next));
  } else if (better(next, *known)) {
    *known = std::move(next);
  }
}

}  // namespace

std::vector<Ranked> rank_effects(const Scorer& scorer, const std::vector<Candidate>& candidates) {
  std::vector<Score> scores(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t c) {
    scores[c] = scorer.score(candidates[c].tangent);
    if (!candidates[c].allows(scores[c].amplitude)) scores[c].log_bayes_factor = kImpossible;
  });
  std::vector<Ranked> ranked;
  std::map<std::string, std::vector<double>> factors;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    factors[candidates[c].effect].push_back(scores[c].log_bayes_factor);
    auto at = std::find_if(ranked.begin(), ranked.end(), [&](const Ranked& r) { return r.effect == candidates[c].effect; });
    if (at == ranked.end()) at = ranked.insert(ranked.end(), {candidates[c].effect, {}, 0.0});
    keep_best_of_form({&candidates[c], std::move(scores[c])}, at->forms);
  }
  for (Ranked& r : ranked) {
    r.evidence = log_mean_exp(factors[r.effect]);
    std::stable_sort(r.forms.begin(), r.forms.end(), better);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.evidence > b.evidence; });
  return ranked;
}

}  // namespace tissue_stiffness
