#include "diagnosis/estimate_at_last.hpp"

#include "estimation/reuse_sources.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

Estimate estimate_at_last(const Diagnosis& diagnosis, const FittedModel& given, const FittedModel& last,
                          const RecordingFit* finer) {
  if (last.recording_fit->model().nonlinear()) return diagnosis.estimate;
  const Recording& recording = given.recording_fit->recording();
  const Model& model = given.recording_fit->model();
  const ReuseSources relatives{last.recording_fit->reduced().get(), finer != nullptr ? finer->reduced().get() : nullptr};
  Estimator estimator(extend_model(model.settings(), diagnosis.entries), model.mesh(), relatives);
  estimator.set_first_stamp(recording.first_stamp);
  for (const LoadSample& load : recording.loads) estimator.add_load(load);
  estimator.replay(recording.frames, &diagnosis.estimate, recording.checkpoint);
  return estimator.estimate();
}

}  // namespace tissue_stiffness
