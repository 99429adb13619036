#include "tools/estimate_jointly.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "estimation/joint_estimate.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_text.hpp"
#include "tools/recording_reader.hpp"
#include "tools/versions.hpp"

namespace tissue_stiffness {
namespace {

bool is_model(const std::string& file) {
  const std::filesystem::path end = std::filesystem::path(file).extension();
  return end == ".yaml" || end == ".yml";
}

BodyRecording read(const RecordingFile& file, std::size_t max_frames, const StopRequest& stop) {
  BodyRecording out;
  out.name = file.recording;
  out.predicted = file.predicted;
  out.settings = load_model(file.model);
  if (out.settings.map) throw InputError(file.model + ": map", "a map", "none, with several recordings");
  if (out.settings.estimator != ModelSettings().estimator)
    throw InputError(file.model + ": estimator", out.settings.estimator, "the default one, with several recordings");
  RecordingReader reader(file.recording, out.settings, [&stop] { stop.check(); });
  out.recording = read_recording(reader, out.settings, file.recording);
  out.mesh = reader.mesh();
  out.recording.checkpoint = [&stop] { stop.check(); };
  if (max_frames > 0 && out.recording.frames.size() > max_frames) out.recording.frames.resize(max_frames);
  return out;
}

RecordingRecord record_of(const RecordingSummary& summary) {
  RecordingRecord out;
  out.name = summary.name;
  out.predicted = summary.predicted;
  out.frames = static_cast<int>(summary.frames);
  out.state_alone = summary.alone.state;
  out.alone = summary.alone.parameters;
  out.rms_error = summary.rms_error;
  out.noise_rms = summary.noise_rms;
  out.rms_sigma = summary.rms_sigma;
  out.relative_error = summary.rms_error / summary.motion_rms;
  if (!summary.test.empty()) out.misfit_z = summary.test.z();
  out.misfit_passes = summary.test.passes();
  if (summary.agreement.dof > 0) out.agreement_z = summary.agreement.z();
  out.agreement_dof = summary.agreement.dof;
  out.agrees = summary.agreement.passes();
  return out;
}

void take_errors(const JointEstimate& joint, Results& results) {
  double error = 0.0, motion = 0.0, noise = 0.0, lengths = 0.0;
  for (const RecordingSummary& r : joint.recordings) {
    results.recordings.push_back(record_of(r));
    if (r.predicted || !(r.lengths > 0.0)) continue;
    error += r.lengths * r.rms_error * r.rms_error;
    motion += r.lengths * r.motion_rms * r.motion_rms;
    noise += r.lengths * r.noise_rms * r.noise_rms;
    lengths += r.lengths;
  }
  results.rms_error = std::sqrt(error / lengths);
  results.noise_rms = std::sqrt(noise / lengths);
  results.relative_error = std::sqrt(error / motion);
}

Results results_of(const JointEstimate& joint) {
  Results out;
  take_errors(joint, out);
  for (std::size_t i = 0; i < joint.estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = joint.estimate.parameters[i];
    if (joint.recording[i] >= 0) {
      out.recordings[static_cast<std::size_t>(joint.recording[i])].own.push_back(parameter);
      continue;
    }
    out.parameters.push_back(parameter);
    out.variance.push_back(joint.estimate.variance[i]);
  }
  out.state = joint.estimate.state;
  out.state_reason = joint.estimate.state_reason;
  out.inputs = joint.estimate.inputs;
  for (const auto& [name, found] : joint.identifiable) out.identifiable[name] = {found.verdict, found.reason};
  out.description = joint.description;
  return out;
}

}  // namespace

std::vector<RecordingFile> pair_files(const std::vector<std::string>& files, std::string model, bool predicted) {
  std::vector<RecordingFile> out;
  bool waiting = false;
  for (const std::string& file : files) {
    if (is_model(file)) {
      if (waiting) break;
      model = file;
    } else {
      out.push_back({model, file, predicted});
    }
    waiting = is_model(file);
  }
  if (waiting) throw InputError(model, "no recording behind this model file", "MODEL.yaml RECORDING.bag ...");
  return out;
}

EstimationRun estimate_jointly(const std::vector<RecordingFile>& files, const std::vector<std::string>& own,
                               std::size_t max_frames, StepProgress& progress, const StopRequest& stop) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<BodyRecording> recordings;
  for (const RecordingFile& file : files) {
    progress.show("read " + file.recording);
    recordings.push_back(read(file, max_frames, stop));
  }
  EstimationRun run;
  run.results =
      results_of(estimate_jointly(recordings, own, [&](const std::string& what, std::size_t done, std::size_t total) {
        progress.show(what, done, total);
      }));
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const RecordingFile& file : files) {
    Results& results = run.results;
    results.recording += (results.recording.empty() ? "" : ", ") + file.recording;
    if (results.model.find(file.model) != std::string::npos) continue;
    results.model += (results.model.empty() ? "" : ", ") + file.model;
    results.model_text += (results.model_text.empty() ? "" : "# " + file.model + "\n") + read_text(file.model);
  }
  run.results.nodes = recordings.front().mesh.node_count();
  run.results.tetrahedra = recordings.front().mesh.tet_count();
  run.results.versions = versions();
  return run;
}

}  // namespace tissue_stiffness
