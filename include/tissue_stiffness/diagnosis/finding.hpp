#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/diagnosis/finer_mesh.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {

/// What one look at a fitted model finds missing.
struct Finding {
  std::string verdict;  ///< adequate, missing, numerics or unexplained
  std::vector<std::string> set;
  std::vector<MissingEffect> effects;  ///< best first
  std::vector<Refit> refits;           ///< best first
  double floor = 0.0;                  ///< rms of what a finer mesh would change [sigma]
  FinerMesh finer;
  Library library;  ///< that the tangents were read from
};

/// Hears of the candidates, best first, whenever more is known of them.
using CandidatesSoFar = std::function<void(std::vector<MissingEffect>)>;

/// Ranks the library by tangents, refits the best (or `wanted` ones, if any), and the best pairs where no single effect
/// explains the error. `finer`: as an earlier look at the same recording found it; empty: found out now.
/// `library`: see find_candidates. `so_far` hears of the tangents' ranking, and of what refits
/// make of it. Throws InputError for a wanted effect that nothing proposes.
Finding look(
    const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
    const FinerMesh& finer = {}, const Library& library = {},
    const CandidatesSoFar& so_far = [](std::vector<MissingEffect>) {});

/// Held-out frames agree that the refit is better than the base.
bool proven(const Fitted& base, const Refit& refit);

}  // namespace tissue_stiffness
