#include <algorithm>
#include <map>

#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kWays = 4;  // of each effect, best first

struct Way {
  const Candidate* candidate;
  double log_bayes_factor;
};

std::vector<Way> best_ways(const Scorer& scorer, const std::vector<Candidate>& candidates) {
  std::map<std::string, std::vector<Way>> by_effect;
  for (const Candidate& candidate : candidates) {
    by_effect[candidate.effect].push_back({&candidate, scorer.score(candidate.tangent).log_bayes_factor});
  }
  std::vector<Way> best;
  for (auto& [effect, ways] : by_effect) {
    const auto better = [](const Way& a, const Way& b) { return a.log_bayes_factor > b.log_bayes_factor; };
    std::stable_sort(ways.begin(), ways.end(), better);
    best.insert(best.end(), ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(std::min(kWays, ways.size())));
  }
  return best;
}

}  // namespace

std::vector<RankedPair> rank_pairs(const Scorer& scorer, const std::vector<Candidate>& candidates) {
  const std::vector<Way> ways = best_ways(scorer, candidates);
  std::map<std::pair<std::string, std::string>, RankedPair> best;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (std::size_t j = i + 1; j < ways.size(); ++j) {
      const Candidate &a = *ways[i].candidate, &b = *ways[j].candidate;
      if (a.effect == b.effect) continue;
      const Eigen::Index split = a.tangent.columns.cols();
      const Score score = scorer.score(a.tangent, b.tangent);
      const Eigen::VectorXd first = score.amplitude.head(split),
                            second = score.amplitude.tail(score.amplitude.size() - split);
      if (!a.allows(first) || !b.allows(second)) continue;
      const double alone = std::max(ways[i].log_bayes_factor, ways[j].log_bayes_factor);
      RankedPair& known = best[{a.effect, b.effect}];
      if (known.first.way != nullptr && known.evidence >= score.log_bayes_factor) continue;
      known = {{&a, first}, {&b, second}, score.log_bayes_factor, score.log_bayes_factor - alone};
    }
  }
  std::vector<RankedPair> pairs;
  for (const auto& [effects, pair] : best) pairs.push_back(pair);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const RankedPair& a, const RankedPair& b) { return a.evidence > b.evidence; });
  return pairs;
}

}  // namespace tissue_stiffness
