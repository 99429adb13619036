#pragma once

#include <algorithm>
#include <string>

#include "diagnosis/finding.hpp"

namespace tissue_stiffness {

/// Returns a pointer to the refit of that effect in a finding; null where the effect was not refitted.
template <typename F>
auto refit_of(F& finding, const std::string& effect) -> decltype(finding.refits.data()) {
  const auto same = [&effect](const Refit& refit) { return refit.effect == effect; };
  const auto at = std::find_if(finding.refits.begin(), finding.refits.end(), same);
  return at == finding.refits.end() ? nullptr : &*at;
}

/// Returns the refit's model, run in full where that was not worth it before. It has the priors of the refit: those around
/// its fit would hold it to what it was while something else was missing. The refit loses its model.
FittedModel extended(const FittedModel& base, const Refit& refit);

/// Returns the library of tangents that a round on `next`, the model of that finding with one effect more, may take over.
Library library_for(const FittedModel& model, const FittedModel& next, const Finding& finding);

/// Returns what a round on a model with one effect more takes over from that finding.
PreviousRound after_adding(const Finding& finding, const Library& library);

/// Repeats rounds until the model fits nowhere better. `moved` says whether it does not stay where it was.
Finding examine(
    FittedModel& model, const DiagnosisOptions& options, const PreviousRound& previous, bool& moved,
    const CandidatesSoFar& so_far = [](const std::vector<MissingEffect>&) {});

}  // namespace tissue_stiffness
