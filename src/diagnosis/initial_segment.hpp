#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/candidates.hpp"
#include "fit/recording_fit.hpp"

namespace tissue_stiffness {

constexpr double kInitialSegment = 0.3;  // share of the frames

/// A fit of the initial segment only ranks the places where fits of the whole recording may start. Phases that drift apart
/// hide the minimum from tangents and from fits of a whole recording, but not there. What explains a recording also
/// explains its initial segment. The shape of what is added stays as proposed (Proposal::with_given_shape).
struct RankedFit {
  std::map<std::string, double> parameters;  ///< of the base with one proposal more, by name
  /// Sum of squared errors over sigma, plus Schwarz's penalty for what was added to the base.
  double deviance = no_rival;
};

/// Scans the amplitude of the candidate and the base's parameters across their whole priors, and returns the best two
/// places, best first. `others` are candidates that differ from it in their start alone. All their starts are run at the
/// base's parameters, and the best ones are scanned. Where an effect is strong, its tangents do not tell its place. Throws
/// NumericalError when no place can be run.
std::vector<RankedFit> scan_initial_segment(const FittedModel& base, const Candidate& candidate,
                                            const std::vector<const Candidate*>& others = {});

/// Fits the base with the candidate's proposal from each of these places, and returns the best fit.
/// Parameters without a value start at their priors. `rival` is a deviance to be beaten (fit_batch). Throws NumericalError
/// when a start cannot be run.
RankedFit fit_initial_segment(const FittedModel& base, const Candidate& candidate,
                              const std::vector<std::map<std::string, double>>& starts, double rival = no_rival);

}  // namespace tissue_stiffness
