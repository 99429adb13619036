#include "tissue_stiffness/diagnosis/replay_model.hpp"

#include "tissue_stiffness/estimation/free_run.hpp"
#include "tissue_stiffness/estimation/replay_recorder.hpp"

namespace tissue_stiffness {

Replay replay_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                    const std::map<std::string, double>& parameters, const std::vector<double>& picture_stamps) {
  Model model(settings, mesh);
  model.set_first_stamp(recording.first_stamp);
  for (const LoadSample& sample : recording.loads) {
    const auto course = model.courses().find(sample.topic);
    if (course != model.courses().end()) course->second->add(sample.time, sample.value);
  }
  const auto forward = make_forward_model(model);
  const auto operators = make_observation_operators(model);
  Eigen::VectorXd w = model.prior_mean();
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const FreeParameter& free = model.free_parameters()[static_cast<std::size_t>(i)];
    const auto value = parameters.find(free.name);
    if (value != parameters.end()) w[i] = free.to_coordinate(value->second);
  }
  ReplayRecorder recorder(mesh, recording.first_stamp, picture_stamps);
  free_run({model, *forward, operators, recording.frames, {recording.first_stamp + settings.time.start}}, model.theta(w),
           [&](const FreeFrame& frame) { recorder.add(frame); });
  return recorder.finish();
}

}  // namespace tissue_stiffness
