#include "diagnosis/replay_model.hpp"

#include "estimation/replay_loads.hpp"
#include "estimation/replay_recorder.hpp"

namespace tissue_stiffness {

Replay replay_model(FittedModel& fitted, const std::vector<double>& picture_stamps) {
  RecordingFit& recording_fit = *fitted.recording_fit;
  ReplayRecorder recorder(recording_fit.model().mesh(), recording_fit.recording().first_stamp, picture_stamps);
  recording_fit.show(fitted.fit.w, [&](const FreeFrame& frame) { recorder.add(frame); });
  Replay replay = recorder.finish();
  const Model& model = recording_fit.model();
  add_loads(model, model.parameters().theta(fitted.fit.w), replay);
  return replay;
}

}  // namespace tissue_stiffness
