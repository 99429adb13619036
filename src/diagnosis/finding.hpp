#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/hypotheses.hpp"
#include "diagnosis/refit.hpp"
#include "diagnosis/screening.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"

namespace tissue_stiffness {

/// A finding is what one round finds missing in a fitted model.
struct Finding {
  Verdict verdict = Verdict::unexplained;
  Comparison comparison;
  std::vector<std::string> set;        ///< see believed_effects; empty where nothing is missing
  std::vector<MissingEffect> effects;  ///< best first
  std::vector<Refit> refits;           ///< best first
  double discretisation_error = 0.0;   ///< rms of what a finer mesh would change [sigma]
  PreviousRound previous;              ///< for the next round
  bool base_moved = false;             ///< the base fits better elsewhere, and has been moved there
  bool to_repeat = false;  ///< nothing explains the recording, and all effects have to be compared from the moved base
  std::shared_ptr<const ModelComparison> models;
  std::string failure;  ///< why the last refit that could not be run failed; empty: none

  /// Takes verdict, set and the effects' probabilities from that comparison.
  void believe(Comparison known);
  /// Weighs and tests all hypotheses anew by that likelihood, with its noise and its error of the mesh. The most probable
  /// effect then leads the refits.
  void judge_by(std::shared_ptr<const ModelComparison> likelihood);
  /// Lets the refit of that effect lead, if there is one.
  void put_first(const std::string& effect);
  /// Replaces what was found without the `leader` by what was found beside it.
  void take_over(const std::string& leader, const std::vector<MissingEffect>& deeper);
};

/// It hears of the candidates, best first, whenever more is known of them.
using CandidatesSoFar = std::function<void(std::vector<MissingEffect>)>;

/// Makes one round of diagnosis: ranks the library by tangents, refits it (or `wanted` effects, if any), and compares what
/// was fitted. The base is moved to where it fits best. `so_far` hears of the tangents' ranking, and of what refits make of
/// it. There are no refits of wanted effects that the library does not propose, or that cannot be run.
Finding diagnose_once(
    FittedModel& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
    const PreviousRound& previous = {}, const CandidatesSoFar& so_far = [](const std::vector<MissingEffect>&) {});

}  // namespace tissue_stiffness
