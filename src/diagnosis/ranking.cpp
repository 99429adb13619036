#include "tissue_stiffness/diagnosis/ranking.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kImpossible = -1e3;  // log Bayes factor of an amplitude out of bounds
constexpr double kEvidence = 5.0;     // log Bayes factor from which an effect is declared
constexpr double kSignificance = 0.01;
constexpr double kOverFloor = 0.75;  // of what the numerics may explain
constexpr double kLeastSize = 0.1;   // [sigma]; false winners on clean recordings stay below

}  // namespace

std::vector<Ranked> rank(const Scorer& scorer, const std::vector<Candidate>& candidates, double floor) {
  std::vector<Score> scores(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t c) {
    scores[c] = scorer.score(candidates[c].tangent);
    if (!candidates[c].allows(scores[c].amplitude)) scores[c].log_bayes_factor = kImpossible;
    scores[c].p_value = candidates[c].p_value(scores[c]);
  });
  std::vector<Ranked> ranked;
  std::map<std::string, std::vector<double>> factors;
  std::map<std::string, std::vector<const Score*>> ways;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    factors[candidates[c].effect].push_back(scores[c].log_bayes_factor);
    ways[candidates[c].effect].push_back(&scores[c]);
    auto at = std::find_if(ranked.begin(), ranked.end(), [&](const Ranked& r) { return r.effect == candidates[c].effect; });
    if (at == ranked.end()) at = ranked.insert(ranked.end(), {candidates[c].effect, nullptr, {}, 0.0, 1.0, false, false});
    if (at->best != nullptr && scores[c].log_bayes_factor <= at->score.log_bayes_factor) continue;
    at->best = &candidates[c];
    at->score = scores[c];
  }
  const double effects = static_cast<double>(ranked.size());
  for (Ranked& r : ranked) {
    r.evidence = log_mean_exp(factors[r.effect]);
    r.p_value = combined_p_value(ways[r.effect]);
    r.promising = r.evidence > kEvidence && r.score.size > std::max(kOverFloor * floor, kLeastSize);
    r.declared = r.promising && r.p_value * effects < kSignificance;
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.evidence > b.evidence; });
  return ranked;
}

}  // namespace tissue_stiffness
