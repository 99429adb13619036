#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/estimation/free_run.hpp"
#include "tissue_stiffness/estimation/relatives.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// What one step of the estimator gives.
struct StepResult {
  bool used = false;  ///< false: the frame was skipped, `reason` says why, the estimate is unchanged
  std::string reason;
  Estimate estimate;
  Misfit misfit;
  std::map<std::string, double> seconds;  ///< wall time of each stage: predict, observe, update, revisit
};

/// Whether the data determine a parameter, and why.
struct Identifiability {
  std::string verdict;  ///< "absolute", "ratio_only" or "none"
  std::string reason;
};

/// The online estimator: frames in order of time go in, the posterior of the model's unknown parameters comes out.
/// Not thread safe; one instance serves one stream.
class Estimator {
 public:
  /// Throws InputError for a model that does not fit the mesh or the effects' specs.
  Estimator(const ModelSettings& settings, const TetMesh& mesh, const Relatives& relatives = {});
  ~Estimator();
  Estimator(Estimator&&) noexcept;

  /// Topics of the measured loads (pressure, wrench) that the model's effects ask for.
  const std::vector<LoadInput>& load_inputs() const;

  /// Instant at which the body was at rest [s]: `time.start` counts from the recording's first stamp, which the caller
  /// knows. Without this call the first frame's or load's time is taken as the first stamp.
  void set_first_stamp(double time);

  /// Lets what takes long (another look at all frames so far, the study of the mesh's error) run beside the frames instead
  /// of holding one up; which frame first sees its result then depends on timing.
  void work_in_background();

  /// Feeds a load. Samples may come in any order up to the frame that needs them; between samples loads are linear in time,
  /// outside they are held.
  void add_load(const LoadSample& sample);

  /// Predict, observe, update. A frame that is late, empty or makes the model diverge is skipped with the reason; never
  /// throws on data.
  StepResult step(const Frame& frame);

  /// What a look that ended after the last frame makes of that frame; empty when there is nothing new. For whoever works in
  /// the background and has no frame to step with: never throws on data.
  std::optional<StepResult> catch_up();
  /// Such a look is under way.
  bool looks_back() const;

  /// Steps through frames that were measured before, waiting for every look back, and with one look at
  /// the mesh's error, at the end; the last used one's result, or the last's. `near`: the estimate as other means have it:
  /// the first sigma points lie there, and nothing is looked at again before the end. `checkpoint` is called before every
  /// frame; what it throws ends the replay, and the estimator must then be reset.
  StepResult replay(
      const std::vector<Frame>& frames, const Estimate* near = nullptr, const std::function<void()>& checkpoint = [] {});

  /// Back to the prior; loads and frames are forgotten.
  void reset();

  const TetMesh& mesh() const;
  const Estimate& estimate() const;
  /// Displacement of every mesh node at the last frame, at the estimate [m].
  const Eigen::Matrix3Xd& displacement() const;
  /// The last frame's measurement against the model at the estimate.
  const Prediction& prediction() const;
  /// By parameter name.
  std::map<std::string, Identifiability> identifiability() const;
  /// What the reduced basis leaves out of the surface's motion, an upper bound (basis_error.hpp): rms of the worst frame
  /// [m]. None for a model that is integrated in full, and before a few frames.
  std::optional<double> basis_error() const;
  /// What the estimator chose by itself, one line each (engine, time step, basis size, nodes), for logs and reports.
  std::vector<std::string> description() const;

  /// The free run from rest to the last frame at the final estimate, compared with every frame kept: what rms_error,
  /// relative_error and the reports are made of. One misfit a kept frame; `visit` sees each.
  std::vector<Misfit> free_run(const FreeFrameVisitor& visit = {});

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tissue_stiffness
