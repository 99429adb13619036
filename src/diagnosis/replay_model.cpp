#include "tissue_stiffness/diagnosis/replay_model.hpp"

#include "tissue_stiffness/estimation/free_run.hpp"
#include "tissue_stiffness/estimation/replay_recorder.hpp"

namespace tissue_stiffness {

Replay replay_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                    const std::map<std::string, double>& parameters, const std::vector<double>& picture_stamps) {
  Model model(settings, mesh);
  model.drive(recording.first_stamp, recording.loads);
  const auto forward = make_forward_model(model);
  const auto operators = make_observation_operators(model);
  const Eigen::VectorXd w = model.coordinates(parameters, model.prior_mean());
  ReplayRecorder recorder(mesh, recording.first_stamp, picture_stamps);
  free_run({model, *forward, operators, recording.frames, {recording.first_stamp + settings.time.start}}, model.theta(w),
           [&](const FreeFrame& frame) { recorder.add(frame); });
  return recorder.finish();
}

}  // namespace tissue_stiffness
