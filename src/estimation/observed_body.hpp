#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimation/reuse_sources.hpp"
#include "fit/free_run.hpp"
#include "forward/forward_model.hpp"
#include "forward/model.hpp"
#include "observation/observation_operator.hpp"
#include "tissue_stiffness/estimation/state_limits.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {

/// The observed body is what every estimator needs of its recording: the model with its loads, its forward model, the
/// operators of its sensors, and the clock.
class ObservedBody {
 public:
  /// Throws InputError for a model that does not fit the mesh, and for one without free parameters or observations.
  ObservedBody(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives);

  Model& model() { return *model_; }
  const Model& model() const { return *model_; }
  const std::vector<std::unique_ptr<ObservationOperator>>& operators() const { return operators_; }
  const std::shared_ptr<ForwardModel>& forward() const { return forward_; }
  void set_forward(std::shared_ptr<ForwardModel> forward) { forward_ = std::move(forward); }

  const std::optional<double>& first_stamp() const { return first_stamp_; }
  void set_first_stamp(double time);
  /// Takes the first stamp of a recording from what has come so far, and from this frame's time.
  void guess_first_stamp(double time);
  /// Returns the time [s] at which the runs begin.
  double start() const { return first_stamp_.value_or(0.0) + model_->settings().time.start; }
  /// Throws InputError for a load that is not finite, has the wrong size or has no time.
  void add_load(const LoadSample& sample);
  const StateLimits& state_limits() const { return limits_; }
  void set_state_limits(const StateLimits& limits) { limits_ = limits; }
  /// Names the load that has not come for longer than `stale_after` before `time` [s]; empty: none.
  std::string stale_load(double time) const;
  /// Forgets loads, stamps and a velocity that was read from frames.
  void forget();

  Estimate prior_estimate() const;
  Prediction at_rest(const Frame& frame) const;
  /// Returns whether the frame holds anything to compare. Throws InputError for an observation that does not fit the model.
  bool sees(const Frame& frame) const;
  /// Notes the nodes that the frame sees. Returns true if the forward model's output has to be extended to some of them.
  bool note_nodes_of(const Frame& frame);
  /// Makes the forward model's output hold the nodes that frames have seen; it may leave out others. No run may be under
  /// way.
  void extend_output();
  /// Compares the free run at `theta` with each of the frames.
  std::vector<Misfit> compare_free_run(const std::vector<Frame>& frames, const RunStart& start,
                                       const Eigen::VectorXd& theta, const FreeFrameVisitor& visit,
                                       const std::vector<ParameterChange>& changes = {});

 private:
  std::unique_ptr<Model> model_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  std::shared_ptr<ForwardModel> forward_;
  std::vector<char> seen_nodes_;  ///< one flag a node: observed so far
  StateLimits limits_;
  std::optional<double> first_stamp_;
  double first_load_ = std::numeric_limits<double>::infinity();  ///< time of the earliest load [s]
};

}  // namespace tissue_stiffness
