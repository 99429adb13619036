#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/estimation/state_limits.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/free_frame.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

struct ReuseSources;

/// A step of the estimator gives this result.
struct StepResult {
  bool used = false;  ///< false: the frame was skipped for `reason`, and the estimate is unchanged
  std::string reason;
  int repeated = 0;  ///< number of observations that were left out because they equal another one of the frame
  Estimate estimate;
  Misfit misfit;
  std::map<std::string, double> seconds;  ///< wall time of each stage [s]: predict, observe, update, reprocess, ...
};

/// It tells whether the data determine a parameter, and why.
struct Identifiability {
  std::string verdict;  ///< "absolute", "ratio_only" or "none"
  std::string reason;
};

/// The online estimator takes frames in order of time and returns the posterior of the model's unknown parameters. It is
/// not thread safe; one instance serves one stream.
class Estimator {
 public:
  /// Throws InputError for a model that does not fit the mesh or the effects' specs.
  Estimator(const ModelSettings& settings, const TetMesh& mesh);
  /// Takes over what the model has in common with `relatives`.
  Estimator(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives);
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  /// Returns the topics of the measured loads (pressure, wrench) that the model's effects ask for.
  const std::vector<LoadInput>& load_inputs() const;

  /// Sets the recording's first stamp [s], which only the caller knows; the body was at rest `time.start` after it. Without
  /// this call the first frame's or load's time is taken as the first stamp.
  void set_first_stamp(double time);

  /// Moves long work (the reprocessing of all frames so far, the study of the mesh's error) into the background, so that no
  /// frame waits for it. Which frame first sees a result then depends on timing.
  void work_in_background();

  /// Sets the limits by which the states of later frames are judged. Without this call `stale_after` is the model's.
  void set_state_limits(const StateLimits& limits);

  /// Feeds a load. Samples may come in any order up to the frame that needs them. Between samples loads are linear in time;
  /// outside they are held.
  void add_load(const LoadSample& sample);

  /// Predicts, observes and updates. A frame is skipped with the reason when it is late, empty or makes the model diverge,
  /// and when a load is silent: its last sample is older than five of its intervals. It never throws on data.
  StepResult step(const Frame& frame);

  /// Returns what a reprocessing that ended after the last frame makes of that frame; empty when there is nothing new. A
  /// caller that works in the background and has no frame to step with uses it. It never throws on data.
  std::optional<StepResult> catch_up();
  /// Returns true while such a reprocessing is under way.
  bool reprocesses() const;

  /// Steps through frames that were measured before. It waits for every reprocessing, and studies the mesh's error once, at
  /// the end. Returns the result of the last frame that was used, or of the last one. `near` is an estimate from elsewhere:
  /// the first sigma points lie around it, and nothing is reprocessed before the end. `checkpoint` is called before every
  /// frame; what it throws ends the replay, and the estimator must then be reset.
  StepResult replay(
      const std::vector<Frame>& frames, const Estimate* near = nullptr, const std::function<void()>& checkpoint = [] {});

  /// Goes back to the prior; loads and frames are forgotten.
  void reset();

  const TetMesh& mesh() const;
  const Estimate& estimate() const;
  /// Returns the displacement of every mesh node at the last frame, at the estimate [m].
  const Eigen::Matrix3Xd& displacement() const;
  /// Returns the last frame's measurement with the model's prediction at the estimate.
  const Prediction& prediction() const;
  /// Returns the verdicts by parameter name.
  std::map<std::string, Identifiability> identifiability() const;
  /// Returns what the reduced basis leaves out of the surface's motion, an upper bound (basis_error.hpp): rms of the worst
  /// frame [m]. There is none for a model that is integrated in full, and before a few frames.
  std::optional<double> basis_error() const;
  /// Returns what the estimator chose by itself, one line each (engine, time step, basis size, nodes), for logs and
  /// reports.
  std::vector<std::string> description() const;

  /// Compares the free run at the final estimate, from rest to the last frame, with every frame kept. From it come
  /// rms_error, relative_error and the reports. Returns one misfit for each kept frame; `visit` sees each.
  std::vector<Misfit> free_run(const FreeFrameVisitor& visit = {});

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tissue_stiffness
