#pragma once

#include <string>
#include <vector>

#include "diagnosis/candidates.hpp"

namespace tissue_stiffness {

struct ScoredCandidate {
  const Candidate* candidate = nullptr;
  Score score;
};

/// A ranked effect comes with the best of its candidates.
struct Ranked {
  std::string effect;
  std::vector<ScoredCandidate> forms;  ///< the best candidate of each form (Proposal::form), best first
  double evidence = 0.0;               ///< log-mean-exp of the log Bayes factors of all candidates

  const Candidate& best() const { return *forms.front().candidate; }
  const Score& score() const { return forms.front().score; }
};

/// Returns all proposed effects, most evidence first.
std::vector<Ranked> rank_effects(const Scorer& scorer, const std::vector<Candidate>& candidates);

}  // namespace tissue_stiffness
