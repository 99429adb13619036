#include "tools/estimate_recording.hpp"

#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include "estimation/map_stiffness.hpp"
#include "estimation/patch_model.hpp"
#include "estimation/replay_loads.hpp"
#include "estimation/replay_recorder.hpp"
#include "filter/consistency.hpp"
#include "report/map_vtk.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_text.hpp"
#include "tools/recording_reader.hpp"
#include "tools/versions.hpp"

namespace tissue_stiffness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostShownLoads = 200000;  // some 30 MB

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

FrameRecord record_of(const Instant& instant, const StepResult& step) {
  FrameRecord record;
  record.time = instant.frame.time;
  record.used = step.used;
  record.reason = step.reason;
  record.state = step.estimate.state;
  record.state_reason = step.estimate.state_reason;
  record.parameters = step.estimate.parameters;
  if (!step.used) return record;
  record.misfit_rms = step.misfit.rms;
  record.misfit_sigma = step.misfit.rms_sigma;
  record.nis = step.misfit.nis;
  record.dof = step.misfit.dof;
  record.outliers = step.misfit.outliers;
  return record;
}

/// Sum of the squared noise, as stated in the model file, over rows.
struct NoiseSum {
  double sum = 0.0;
  double rows = 0.0;
  void add(const Frame& frame, const ModelSettings& settings) {
    for (const Observation& observation : frame.observations) {
      if (traits_of(observation.kind).force) continue;
      const double noise = settings.observations[static_cast<std::size_t>(observation.source)].noise;
      const double count =
          static_cast<double>(observation.contour ? observation.contour->size() : observation.points.cols());
      sum += count * noise * noise;
      rows += count;
    }
  }
};

/// One run, which turns frames into records.
class Run {
 public:
  Run(const ModelSettings& settings, RecordingReader& recording, const StopRequest& stop)
      : settings_(settings), recording_(recording), stop_(stop), estimator_(settings, recording.mesh()) {
    estimator_.set_first_stamp(recording.reader().first_stamp());
    if (settings.map) require_map(Model(settings, recording.mesh()));
  }

  /// Returns whether the frame was used; otherwise `reason` says why not.
  bool step(const Instant& instant, std::string& reason) {
    for (const LoadSample& sample : instant.loads) estimator_.add_load(sample);
    if (settings_.map || loads_.size() < kMostShownLoads)
      loads_.insert(loads_.end(), instant.loads.begin(), instant.loads.end());
    const auto start = Clock::now();
    StepResult result;
    if (instant.frame.observations.empty()) {
      result.reason = instant.reason;
      result.estimate = estimator_.estimate();
    } else {
      result = estimator_.step(instant.frame);
    }
    run_.results.frames.push_back(record_of(instant, result));
    if (!result.used) {
      reason = result.reason;
      return false;
    }
    if (settings_.map) frames_.push_back(instant.frame);
    run_.results.frame_seconds.push_back(since(start) + instant.segment_seconds);
    if (instant.segment_seconds > 0.0) run_.stage_samples["segment"].push_back(instant.segment_seconds);
    for (const auto& [stage, seconds] : result.seconds) run_.stage_samples[stage].push_back(seconds);
    nis_.add(result.misfit.nis, result.misfit.dof);
    noise_.add(instant.frame, settings_);
    return true;
  }

  EstimationRun finish() {
    Results& results = run_.results;
    results.parameters = estimator_.estimate().parameters;
    results.state = estimator_.estimate().state;
    results.state_reason = estimator_.estimate().state_reason;
    results.variance = estimator_.estimate().variance;
    results.inputs = estimator_.estimate().inputs;
    for (const auto& [name, found] : estimator_.identifiability()) {
      results.identifiable[name] = {found.verdict, found.reason};
    }
    results.nis_mean_per_dof = nis_.mean_per_dof();
    results.nis_p_value = nis_.p_value();
    results.noise_rms = std::sqrt(noise_.sum / noise_.rows);
    results.basis_error = estimator_.basis_error().value_or(results.basis_error);
    results.description = estimator_.description();
    results.nodes = estimator_.mesh().node_count();
    results.tetrahedra = estimator_.mesh().tet_count();
    for (const auto& [stage, samples] : run_.stage_samples) {
      double sum = 0.0;
      for (const double s : samples) sum += s;
      results.stage_seconds.emplace_back(stage, sum);
    }
    run_.showing = {recording_.reader().first_stamp(), {}, recording_.reader().pictures()};
    try {
      stop_.check();
      if (settings_.map) add_map();
      add_free_run();
    } catch (const Interrupted&) {
      results.interrupted = "the runs at the last estimate";
    }
    run_.late = recording_.reader().late();
    run_.broken_stamps = recording_.reader().broken_stamps();
    run_.last_broken_stamp = recording_.reader().last_broken_stamp();
    return std::move(run_);
  }

 private:
  void add_map() {
    const TetMesh& mesh = estimator_.mesh();
    const StiffnessMap map =
        map_stiffness({settings_, mesh, std::move(frames_), std::move(loads_), recording_.reader().first_stamp(),
                       estimator_.estimate(), recording_.checkpoint()});
    run_.map_vtk = map_vtk(map, mesh);
    run_.results.map = map;
  }

  void add_free_run() {
    double error = 0.0, motion = 0.0, count = 0.0;
    const BagReader& reader = recording_.reader();
    ReplayRecorder recorder(estimator_.mesh(), reader.first_stamp(), reader.picture_stamps());
    const auto record = [&](const FreeFrame& frame) {
      stop_.check();
      recorder.add(frame);
    };
    for (const Misfit& misfit : estimator_.free_run(record)) {
      error += misfit.lengths * misfit.rms * misfit.rms;
      motion += misfit.lengths * misfit.motion_rms * misfit.motion_rms;
      count += misfit.lengths;
    }
    run_.results.rms_error = std::sqrt(error / count);
    run_.results.relative_error = std::sqrt(error / motion);
    Replay replay = recorder.finish();
    if (replay.time.empty()) return;  // of a very long recording the estimator keeps no frames
    replay.name = "the estimate";
    if (settings_.map || loads_.size() < kMostShownLoads) show_loads(replay);
    run_.showing.replays.push_back(std::move(replay));
  }

  void show_loads(Replay& replay) const {
    Model model(settings_, estimator_.mesh());
    model.loads().drive(recording_.reader().first_stamp(), loads_);
    std::map<std::string, double> means;
    for (const ParameterEstimate& p : run_.results.parameters) means[p.name] = p.mean;
    const ParameterSpace& space = model.parameters();
    add_loads(model, space.theta(space.coordinates(means, space.prior_mean())), replay);
  }

  const ModelSettings& settings_;
  RecordingReader& recording_;
  const StopRequest& stop_;
  Estimator estimator_;
  EstimationRun run_;
  ConsistencySum nis_;
  NoiseSum noise_;
  std::vector<Frame> frames_;      ///< those used: for a map
  std::vector<LoadSample> loads_;  ///< for a map, and for the report of a recording that has not too many
};

}  // namespace

EstimationRun estimate_recording(const ModelSettings& settings, const std::string& recording_file, std::size_t max_frames,
                                 const ProgressCallback& progress, const StopRequest& stop) {
  RecordingReader recording(recording_file, settings, [&] { stop.check(); });
  const std::size_t all = recording.reader().frame_count();
  const std::size_t total = max_frames > 0 ? std::min(max_frames, all) : all;
  Run run(settings, recording, stop);
  const auto start = Clock::now();
  std::size_t done = 0;
  std::string reason, interrupted;
  bool used = false;
  try {
    while (max_frames == 0 || done < max_frames) {
      const std::optional<Instant> instant = recording.next();
      if (!instant) break;
      used = run.step(*instant, reason) || used;
      progress(++done, std::max(total, done));
    }
  } catch (const Interrupted&) {
    interrupted = "frame " + std::to_string(done + 1) + " of " + std::to_string(std::max(total, done + 1));
  }
  if (!used && interrupted.empty()) throw InputError(recording_file, "no usable frame (" + reason + ")", "at least one");
  const double seconds = since(start);
  EstimationRun result = run.finish();
  result.seconds = seconds;
  if (!interrupted.empty()) result.results.interrupted = interrupted;
  result.results.model = settings.name;
  result.results.recording = recording_file;
  result.results.model_text = read_text(settings.name);
  result.results.versions = versions();
  return result;
}

}  // namespace tissue_stiffness
