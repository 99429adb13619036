#include "diagnosis/ranking.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kImpossible = -1e3;  // log Bayes factor of an amplitude out of bounds

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
    if (at == ranked.end()) at = ranked.insert(ranked.end(), {candidates[c].effect, nullptr, {}, 0.0});
    if (at->best != nullptr && scores[c].log_bayes_factor <= at->score.log_bayes_factor) continue;
    at->best = &candidates[c];
    at->score = scores[c];
  }
  for (Ranked& r : ranked) r.evidence = log_mean_exp(factors[r.effect]);
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.evidence > b.evidence; });
  return ranked;
}

}  // namespace tissue_stiffness
