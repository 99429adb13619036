#pragma once

#include <string>
#include <vector>

#include "diagnosis/candidates.hpp"

namespace tissue_stiffness {

/// A ranked effect comes with the best of its candidates.
struct Ranked {
  std::string effect;
  const Candidate* best = nullptr;
  Score score;            ///< of the best candidate
  double evidence = 0.0;  ///< log-mean-exp of the log Bayes factors of all candidates
};

/// Returns all proposed effects, most evidence first.
std::vector<Ranked> rank_effects(const Scorer& scorer, const std::vector<Candidate>& candidates);

}  // namespace tissue_stiffness
