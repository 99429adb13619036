#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/diagnosis/first_look.hpp"
#include "tissue_stiffness/diagnosis/model_comparison.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {

/// What one look at a fitted model finds missing.
struct Finding {
  Verdict verdict = Verdict::unexplained;
  Comparison comparison;
  std::vector<std::string> set;        ///< see believed_effects; empty where nothing is missing
  std::vector<MissingEffect> effects;  ///< best first
  std::vector<Refit> refits;           ///< best first
  double floor = 0.0;                  ///< rms of what a finer mesh would change [sigma]
  Earlier earlier;                     ///< for the next look
  bool base_moved = false;             ///< it fits better elsewhere, and has been moved there
  bool to_repeat = false;              ///< nothing explains what it leaves there: the search was not ended
  std::shared_ptr<const ModelComparison> models;

  /// Verdict, set and the effects' probabilities as that comparison has them.
  void believe(Comparison known);
};

/// Hears of the candidates, best first, whenever more is known of them.
using CandidatesSoFar = std::function<void(std::vector<MissingEffect>)>;

/// Ranks the library by tangents, refits it (or `wanted` effects, if any), and compares what was fitted. The base is moved
/// to where it fits best. `so_far` hears of the tangents' ranking, and of what refits make of it. Throws InputError for a
/// wanted effect that nothing proposes.
Finding look(
    Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options, const Earlier& earlier = {},
    const CandidatesSoFar& so_far = [](std::vector<MissingEffect>) {});

}  // namespace tissue_stiffness
