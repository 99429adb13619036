#include "tissue_stiffness/diagnosis/replay_model.hpp"

#include "tissue_stiffness/estimation/replay_recorder.hpp"

namespace tissue_stiffness {

Replay replay_model(Fitted& fitted, const std::vector<double>& picture_stamps) {
  Study& study = *fitted.study;
  ReplayRecorder recorder(study.model().mesh(), study.recording().first_stamp, picture_stamps);
  study.show(fitted.fit.w, [&](const FreeFrame& frame) { recorder.add(frame); });
  return recorder.finish();
}

}  // namespace tissue_stiffness
