#include "diagnosis/rounds.hpp"

#include <utility>

#include "forward/extra_force.hpp"
#include "settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostBases = 3;          // rounds that are repeated because the model fits better elsewhere
constexpr double kAddedSpread = 0.02;  // prior standard deviations, of the sigma points of a fit that starts from a refit

// Returns whether all that `next` has beyond the model acts on the body or in a sensor, and leaves the body's own mass and
// stiffness alone.
bool same_body(const Model& model, const Model& next) {
  return std::all_of(next.parts().begin(), next.parts().end(), [&model](const Model::Part& part) {
    const auto same = [&part](const Model::Part& known) { return known.label == part.label; };
    const LinearTerms& terms = part.terms;
    return std::any_of(model.parts().begin(), model.parts().end(), same) ||
           (terms.mass.empty() && terms.stiffness.empty() && terms.strain_stiffness.empty() && !adds_extra_force(part));
  });
}

}  // namespace

FittedModel extended(const FittedModel& base, const Refit& refit) {
  if (refit.model) return std::move(*refit.model);
  auto recording_fit = std::make_unique<RecordingFit>(
      extend_model(base.recording_fit->model().settings(), {refit.proposed}), *base.recording_fit);
  const Model& model = recording_fit->model();
  return fit_recording(std::move(recording_fit),
                       model.parameters().coordinates(refit.parameters, model.parameters().prior_mean()), kAddedSpread);
}

Library library_for(const FittedModel& model, const FittedModel& next, const Finding& finding) {
  return same_body(model.recording_fit->model(), next.recording_fit->model()) ? finding.previous.library : Library();
}

PreviousRound after_adding(const Finding& finding, const Library& library) {
  return {finding.previous.finer, finding.models, library, true};
}

Finding examine(FittedModel& model, const DiagnosisOptions& options, const PreviousRound& previous, bool& moved,
                const CandidatesSoFar& so_far) {
  Finding out = diagnose_once(model, {}, options, previous, so_far);
  moved = out.base_moved;
  for (int k = 1; out.to_repeat; ++k) {
    PreviousRound next = out.previous;
    next.settled = k == kMostBases;
    out = diagnose_once(model, {}, options, next, so_far);
    moved = true;
  }
  return out;
}

}  // namespace tissue_stiffness
