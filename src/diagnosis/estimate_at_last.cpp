#include "diagnosis/estimate_at_last.hpp"

#include "forward/hyper_basis.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

Estimate estimate_by_filter(const ModelSettings& settings, const RecordingFit& recording_fit,
                            const std::vector<Frame>& frames, const Estimate* near, const ReuseSources& relatives) {
  const Recording& recording = recording_fit.recording();
  Estimator estimator(settings, recording_fit.model().mesh(), relatives);
  estimator.set_first_stamp(recording.first_stamp);
  for (const LoadSample& load : recording.loads) estimator.add_load(load);
  estimator.replay(frames, near, recording.checkpoint);
  return estimator.estimate();
}

Estimate estimate_at_last(const Diagnosis& diagnosis, const FittedModel& given, const FittedModel& last,
                          const RecordingFit* finer) {
  const bool nonlinear = last.recording_fit->model().nonlinear();
  if (nonlinear && !why_not_hyper_reduced(last.recording_fit->model()).empty()) return diagnosis.estimate;
  const auto own = nonlinear ? nullptr : last.recording_fit->reduced();
  const auto finer_own = nonlinear || finer == nullptr ? nullptr : finer->reduced();
  const RecordingFit& recording_fit = *given.recording_fit;
  return estimate_by_filter(extend_model(recording_fit.model().settings(), diagnosis.entries), recording_fit,
                            recording_fit.recording().frames, &diagnosis.estimate, {own.get(), finer_own.get()});
}

}  // namespace tissue_stiffness
