#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimation/reuse_sources.hpp"
#include "fit/free_run.hpp"
#include "forward/forward_model.hpp"
#include "observation/observation_operator.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// Every estimation scheme shares the model, its sensors, the clock, and the checks before a frame is used.
class Scheme {
 public:
  Scheme(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives = {});
  virtual ~Scheme() = default;

  StepResult step(const Frame& frame);
  StepResult replay(const std::vector<Frame>& frames, const Estimate* near, const std::function<void()>& checkpoint);
  std::optional<StepResult> catch_up();
  void reset();
  void set_first_stamp(double time);
  void add_load(const LoadSample& sample);

  virtual std::vector<std::string> description() const = 0;
  void work_in_background() { background_ = true; }
  virtual std::vector<Misfit> free_run(const FreeFrameVisitor& visit) = 0;
  virtual Eigen::MatrixXd parameter_covariance() const = 0;  ///< in the filter's coordinates

  const Model& model() const { return *model_; }
  const Estimate& estimate() const { return estimate_; }
  const Eigen::Matrix3Xd& displacement() const;
  /// Returns the error of the reduced basis [m], kBasisSafety included. There is none for a model that runs in full, and
  /// before a few frames.
  virtual std::optional<double> basis_error() const { return std::nullopt; }
  const Prediction& prediction() const { return prediction_; }
  virtual bool reprocesses() const { return false; }

 protected:
  virtual StepResult process(const Frame& frame) = 0;
  /// Returns what reprocessing has brought since the last frame, if one has ended.
  virtual std::optional<StepResult> take_reprocessed() { return std::nullopt; }
  virtual void forget() = 0;
  /// Ends the model's runs in the background, before anything that they read is changed.
  virtual void stop() {}

  /// Frames do not wait for reprocessing, which runs in the background.
  bool hurried() const { return background_ && !replaying_; }
  bool background() const { return background_; }
  /// More frames of a replay follow at once. What is otherwise asked of the recording from time to time is asked at its
  /// last frame.
  bool more_follow() const { return more_follow_; }
  bool replaying() const { return replaying_; }
  /// Returns the estimate from elsewhere that a replay starts with, or null.
  const Estimate* near() const { return near_; }

  double start() const { return first_stamp_.value_or(0.0) + model_->settings().time.start; }
  Prediction at_rest(const Frame& frame) const;
  /// Names the load that has not come for longer than `stale_after` before `time` [s]; empty: none.
  std::string stale_load(double time) const;
  /// Compares the free run at `theta` with each of the frames.
  std::vector<Misfit> compare_free_run(const std::vector<Frame>& frames, const RunStart& start,
                                       const Eigen::VectorXd& theta, const FreeFrameVisitor& visit,
                                       const std::vector<ParameterChange>& changes = {});

  std::unique_ptr<Model> model_;
  std::shared_ptr<ForwardModel> forward_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  Estimate estimate_;
  mutable Eigen::Matrix3Xd displacement_;
  mutable std::function<void(Eigen::Ref<Eigen::VectorXd>)> recover_;  ///< fills displacement_ on demand; may be empty
  Prediction prediction_;
  std::vector<char> seen_nodes_;  ///< one flag a node: observed so far

  /// Makes the forward model's output hold the nodes that frames have seen; it may leave out others.
  void extend_output_to(const Frame& frame);

 private:
  StepResult step_once(const Frame& frame);
  StepResult refuse_silence(double time, const std::string& silence);
  /// Returns whether the frame holds anything to compare. Throws InputError for an observation that does not fit the model.
  bool seen(const Frame& frame) const;

  std::optional<double> first_stamp_;
  double first_load_ = std::numeric_limits<double>::infinity();  ///< time of the earliest load [s]
  std::optional<double> last_time_;
  bool background_ = false, replaying_ = false, more_follow_ = false;
  const Estimate* near_ = nullptr;
};

std::unique_ptr<Scheme> make_unscented_scheme(const ModelSettings& settings, const TetMesh& mesh,
                                              const ReuseSources& relatives);
std::unique_ptr<Scheme> make_paper_scheme(const ModelSettings& settings, const TetMesh& mesh);

}  // namespace tissue_stiffness
