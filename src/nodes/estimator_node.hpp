#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "nodes/estimator_inputs.hpp"
#include "nodes/estimator_outputs.hpp"
#include "nodes/map_publisher.hpp"
#include "nodes/model_services.hpp"
#include "nodes/reconfiguration.hpp"
#include "nodes/ros_settings.hpp"
#include "nodes/setup_watch.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// The online estimator with its topics. Callbacks queue messages. One worker steps over frames and publishes after each.
///
/// `time.start` of the model counts from the first stamp received on any of its topics. The node listens as soon as it is
/// ready (immediately when the mesh comes from the contour). So a recording that waits for subscribers is received from its
/// start. When stamps begin again (a bag that loops, a simulated clock that is reset), the estimator starts from the prior
/// again. When they jump elsewhere, the body need not be at rest, so the estimator starts from motion (resumed_model.hpp);
/// if messages kept coming, the body is the same, and it goes on with the modulus so far. `previous_estimate` of
/// /diagnostics then keeps the result of the run before.
///
/// In the background ModelServices searches for what the model misses. It also adds effects to the running model and
/// removes them. For a model with `map`, MapPublisher maps the modulus over the body in the background.
///
/// Private parameters: `model` (a file) or the model's keys; `model_frame` ("model"), `load_timeout` (0.1 s),
/// `transform_timeout` (0.1 s), `queue_size` (100 frames), `diagnostic_period` (1 s), and LiveOptions, which
/// dynamic_reconfigure changes while the node runs. A frame waits for `load_timeout` for the loads and other sensors up to
/// its stamp. A check uses the frames of `diagnosis_window`.
class EstimatorNode {
 public:
  EstimatorNode(ros::NodeHandle node, const ros::NodeHandle& private_node);
  ~EstimatorNode();

  int exit_code() const { return exit_code_; }

 private:
  EstimatorNode(ros::NodeHandle node, const ros::NodeHandle& private_node, const NodeSettings& settings);

  void on_mesh(const TetMeshConstPtr& message);
  bool on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);

  void run();
  void work();
  std::optional<TetMesh> wait_for_mesh();
  /// Has the worker run a changed model. Throws InputError with the reason if that cannot be built.
  void change_model(const ModelSettings& changed);
  /// Applies options from a callback. What only the worker may use changes before its next frame, in take_options.
  void change_options(const LiveOptions& options);
  void take_options();
  /// Applies changes before the next frame: options, a mesh that arrived, a model that was changed. What cannot be built is
  /// refused, and the worker goes on with what it has. Returns false if waiting frames are of another mesh.
  bool take_changes();
  using Beginning = FrameQueue::Beginning;
  /// Builds an estimator beside the running one, and replaces that. Throws InputError for a model that does not fit the
  /// mesh or cannot begin so, or what the construction throws; nothing has changed then.
  void build(const ModelSettings& settings, const TetMesh& mesh, Beginning beginning);
  void run_again();
  void start_epoch(const FrameQueue::Work& work);
  void begin(Beginning beginning);
  void take(const FrameQueue::Work& work);
  /// Returns whether a frame was used.
  bool process(const FrameQueue::Work& work);
  void catch_up();
  void mark_stale();
  Estimate stale(Estimate estimate) const;
  void show_state(const Estimate& estimate);
  void report(const StepResult& result);

  const ModelSettings settings_;  ///< as it was given
  std::uint32_t queue_size_;
  Diagnostics diagnostics_;
  SensorPoses poses_;
  FrameQueue queue_;
  EstimatorInputs inputs_;
  EstimatorOutputs outputs_;
  MapPublisher map_;
  SetupWatch watch_;
  ModelSettings running_;                    ///< with added effects; used only by the worker, like the estimator
  Beginning beginning_ = Beginning::stated;  ///< of this epoch
  std::optional<Estimate> known_;            ///< what an earlier epoch found of the same body
  std::unique_ptr<Estimator> estimator_;
  std::string why_skipped_;    ///< of the last frame; empty: it was used
  std::optional<Frame> last_;  ///< last frame that was used
  ros::Time last_stamp_;
  std::chrono::steady_clock::time_point arrival_;  ///< of the last frame that was used
  bool stale_ = false;                             ///< it was published since then
  StateLimits limits_;                             ///< used only by the worker

  std::mutex changes_mutex_;
  std::condition_variable mesh_arrived_, answered_;
  LiveOptions options_;  ///< as they are now
  std::optional<TetMesh> mesh_;
  std::optional<ModelSettings> model_;
  std::optional<std::string> answer_;  ///< why the changed model was refused; "": it runs; none: not known yet
  bool stopped_ = false;

  std::atomic<int> exit_code_{0};
  ros::Subscriber mesh_subscriber_;
  ros::ServiceServer reset_service_;
  std::unique_ptr<ModelServices> services_;
  std::unique_ptr<Reconfiguration> reconfiguration_;
  std::thread worker_;
};

}  // namespace tissue_stiffness
