#include "nodes/estimator_node.hpp"

#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <sstream>

#include "estimation/patch_model.hpp"
#include "estimation/resumed_model.hpp"
#include "nodes/message_conversions.hpp"
#include "nodes/node_keys.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::string shown(const Estimate& estimate) {
  std::ostringstream text;
  for (const ParameterEstimate& p : estimate.parameters) {
    text << (text.tellp() > 0 ? ", " : "") << p.name << " " << p.mean << " " << p.unit << " (95 %: " << p.lower95 << " to "
         << p.upper95 << ")";
  }
  return text.str();
}

NodeSettings read_settings(const ros::NodeHandle& private_node) {
  return read_node_settings(private_node, names_of(node_keys("estimator_node")));
}

const KeySpec& key(const std::string& name) {
  return find_key(node_keys("estimator_node"), name);
}

}  // namespace

EstimatorNode::EstimatorNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
    : EstimatorNode(std::move(node), private_node, read_settings(private_node)) {}

EstimatorNode::EstimatorNode(ros::NodeHandle node, const ros::NodeHandle& private_node, const NodeSettings& settings)
    : settings_(read_model(settings.model, settings.directory)),
      queue_size_(static_cast<std::uint32_t>(read_number(settings.own, key("queue_size")))),
      diagnostics_(node, "estimator", read_number(settings.own, key("diagnostic_period"))),
      poses_(read_text(settings.own, key("model_frame")), read_number(settings.own, key("transform_timeout"))),
      queue_(std::chrono::duration<double>(read_number(settings.own, key("load_timeout"))), queue_size_),
      inputs_(node, settings_, poses_, queue_, diagnostics_),
      outputs_(node, poses_.model_frame()),
      map_(node, poses_.model_frame()),
      watch_(node, settings_, diagnostics_),
      running_(settings_),
      options_(read_live_options(settings.own, settings_.stale_after)) {
  services_ = std::make_unique<ModelServices>(node, settings_.directory, poses_.model_frame(), options_.check,
                                              [this](const ModelSettings& changed) { change_model(changed); });
  if (settings_.mesh.source != MeshSettings::Source::file) inputs_.listen(queue_size_);
  reset_service_ = node.advertiseService("reset", &EstimatorNode::on_reset, this);
  mesh_subscriber_ = node.subscribe("mesh", 1, &EstimatorNode::on_mesh, this);
  diagnostics_.state(DiagnosticStatus::WARN, "waiting for mesh");
  reconfiguration_ = std::make_unique<Reconfiguration>(
      private_node, options_, [this](const LiveOptions& options) { change_options(options); },
      [this](const std::string& why) { diagnostics_.bad_message(why); });
  worker_ = std::thread([this] { run(); });
}

EstimatorNode::~EstimatorNode() {
  reconfiguration_.reset();
  {
    const std::lock_guard<std::mutex> lock(changes_mutex_);
    stopped_ = true;
  }
  mesh_arrived_.notify_all();
  answered_.notify_all();
  queue_.stop();
  worker_.join();
}

void EstimatorNode::on_mesh(const TetMeshConstPtr& message) {
  try {
    TetMesh mesh = to_mesh(*message, "mesh");
    const std::lock_guard<std::mutex> lock(changes_mutex_);
    mesh_ = std::move(mesh);
    mesh_arrived_.notify_all();
  } catch (const std::exception& error) {
    diagnostics_.bad_message(error.what());
  }
}

bool EstimatorNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  queue_.restart();
  response.success = 1;
  response.message = "the next frame starts from the prior";
  return true;
}

// This is the worker's outermost function, because no exception may leave a thread.
void EstimatorNode::run() {
  try {
    work();
  } catch (const InputError& error) {
    ROS_FATAL("%s", error.what());
    exit_code_ = 2;
    ros::shutdown();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    exit_code_ = 1;
    ros::shutdown();
  }
  const std::lock_guard<std::mutex> lock(changes_mutex_);
  stopped_ = true;  // a service may wait for an answer
  answered_.notify_all();
}

void EstimatorNode::work() {
  const std::optional<TetMesh> first = wait_for_mesh();
  if (!first) return;
  watch_.mesh_came(*first);
  take_options();
  build(running_, *first, Beginning::stated);
  inputs_.listen(queue_size_);
  while (const auto work = queue_.take()) {
    try {
      if (take_changes()) take(*work);
    } catch (const std::exception& error) {  // no message ends the node
      diagnostics_.bad_message(error.what());
    }
  }
}

void EstimatorNode::take(const FrameQueue::Work& work) {
  diagnostics_.set("frames waiting", std::to_string(queue_.waiting() + 1));  // this one included
  if (!process(work)) {
    catch_up();
    mark_stale();
  }
  diagnostics_.set("frames waiting", std::to_string(queue_.waiting()));
  diagnostics_.set("reprocessing", estimator_->reprocesses() ? "yes" : "no");
}

std::optional<TetMesh> EstimatorNode::wait_for_mesh() {
  std::unique_lock<std::mutex> lock(changes_mutex_);
  mesh_arrived_.wait(lock, [this] { return stopped_ || mesh_; });
  return stopped_ ? std::nullopt : std::exchange(mesh_, std::nullopt);
}

void EstimatorNode::change_options(const LiveOptions& options) {
  services_->check().set_options(options.check);
  diagnostics_.set_longest_silence(options.limits.stale_after);
  const std::lock_guard<std::mutex> lock(changes_mutex_);
  options_ = options;
}

void EstimatorNode::take_options() {
  const std::lock_guard<std::mutex> lock(changes_mutex_);
  limits_ = options_.limits;
  outputs_.set_colour_limit(options_.colour_limit);
  if (estimator_) estimator_->set_state_limits(limits_);
}

bool EstimatorNode::take_changes() {
  take_options();
  std::optional<TetMesh> mesh;
  std::optional<ModelSettings> model;
  {
    const std::lock_guard<std::mutex> lock(changes_mutex_);
    mesh = std::exchange(mesh_, std::nullopt);
    model = std::exchange(model_, std::nullopt);
  }
  if (!mesh && !model) return true;
  std::string refusal;
  try {
    build(model ? *model : running_, mesh ? *mesh : TetMesh(estimator_->mesh()), mesh ? Beginning::stated : beginning_);
  } catch (const std::exception& error) {
    refusal = error.what();
    if (mesh) diagnostics_.bad_message("mesh: the one before is kept: " + refusal);
  }
  if (model) {
    const std::lock_guard<std::mutex> lock(changes_mutex_);
    answer_ = refusal;
    answered_.notify_all();
  }
  if (!refusal.empty()) return true;
  if (mesh) {
    queue_.restart();
    return false;
  }
  run_again();
  return true;
}

void EstimatorNode::change_model(const ModelSettings& changed) {
  std::unique_lock<std::mutex> lock(changes_mutex_);
  model_ = changed;
  answer_.reset();
  queue_.wake();
  answered_.wait(lock, [this] { return stopped_ || answer_; });
  if (!answer_) throw InputError("the node ends; nothing was changed");
  if (!answer_->empty()) throw InputError(*answer_);
}

void EstimatorNode::build(const ModelSettings& settings, const TetMesh& mesh, Beginning beginning) {
  ModelSettings begun = settings;
  if (beginning != Beginning::stated) begun = in_motion(std::move(begun), mesh);
  if (beginning == Beginning::jump && known_) take_moduli(begun, *known_);
  if (begun.map) require_map(Model(begun, mesh));
  auto estimator = std::make_unique<Estimator>(begun, mesh);
  outputs_.prepare(begun, mesh);
  running_ = settings;
  beginning_ = beginning;
  estimator_ = std::move(estimator);
  estimator_->set_state_limits(limits_);
  last_.reset();
  estimator_->work_in_background();
  services_->start(running_, begun, mesh);
  inputs_.set_mesh(mesh);
  map_.start(begun, mesh);
  for (const std::string& line : estimator_->description()) ROS_INFO("%s", line.c_str());
  diagnostics_.state(DiagnosticStatus::OK, to_string(EstimateState::no_data));
}

// A changed model processes the kept frames of this run, so that the measurements are not lost.
void EstimatorNode::run_again() {
  const Recording recording = services_->check().recording();
  estimator_->set_first_stamp(recording.first_stamp);
  for (const LoadSample& load : recording.loads) estimator_->add_load(load);
  if (recording.frames.empty()) return;
  const StepResult result = estimator_->replay(recording.frames);
  report(result);
  if (!result.used) return outputs_.publish(estimator_->estimate(), ros::Time(recording.frames.back().time));
  const auto last = std::find_if(recording.frames.begin(), recording.frames.end(),
                                 [&](const Frame& frame) { return frame.time == result.misfit.time; });
  outputs_.publish(*estimator_, result, *last, ros::Time(last->time));
  last_ = *last;
  last_stamp_ = ros::Time(last->time);
}

// Only an estimate that had converged is believed beyond its own run, and only of the same body.
void EstimatorNode::begin(Beginning beginning) {
  if (beginning != Beginning::jump) known_.reset();
  if (beginning == Beginning::jump && estimator_->estimate().state == EstimateState::converged) {
    known_ = estimator_->estimate();
  }
  if (beginning == Beginning::stated && beginning_ == Beginning::stated) return estimator_->reset();
  const TetMesh mesh = estimator_->mesh();
  try {
    build(running_, mesh, beginning);
  } catch (const std::exception& error) {
    ROS_WARN("the body is taken to be at rest now, as %s", error.what());
    build(running_, mesh, Beginning::stated);
  }
}

void EstimatorNode::start_epoch(const FrameQueue::Work& work) {
  const Estimate previous = estimator_->estimate();
  const ros::Time& first_stamp = work.first_stamp;
  begin(work.beginning);
  why_skipped_.clear();
  if (previous.state != EstimateState::no_data) {
    ROS_INFO("starting again from %s; the run before found %s",
             beginning_ == Beginning::stated ? "the prior and from rest"
             : known_                        ? "the modulus so far and from motion"
                                             : "the prior and from motion",
             shown(previous).c_str());
    diagnostics_.set("previous_estimate", shown(previous));
    diagnostics_.count("restarts");
    outputs_.publish(estimator_->estimate(), first_stamp);  // the last one is latched, and no longer holds
  }
  last_.reset();
  estimator_->set_first_stamp(first_stamp.toSec());
  services_->check().start_epoch(first_stamp.toSec());
  map_.start_epoch();
}

bool EstimatorNode::process(const FrameQueue::Work& work) {
  if (work.new_epoch) start_epoch(work);
  const auto left_out = [this](const auto& convert) {
    try {
      convert();
    } catch (const std::exception& error) {
      diagnostics_.bad_message(error.what());
    }
  };
  for (const auto& load : work.loads)
    left_out([&] {
      const LoadSample sample = load();
      estimator_->add_load(sample);
      services_->check().add(sample);
    });
  Frame frame;
  frame.time = work.stamp.toSec();
  for (const auto& make : work.observations) left_out([&] { frame.observations.push_back(make()); });
  if (frame.observations.empty()) return false;
  const StepResult result = estimator_->step(frame);
  report(result);
  if (!result.used) return false;
  watch_.frame_used(frame, estimator_->mesh(), work.first_stamp.toSec() + running_.time.start);
  services_->check().add(frame);
  if (services_->check().complete()) {
    map_.add_frame(result.estimate, [this] { return services_->check().recording(); });
  }
  outputs_.publish(*estimator_, result, frame, work.stamp);
  last_ = std::move(frame);
  last_stamp_ = work.stamp;
  arrival_ = std::chrono::steady_clock::now();
  stale_ = false;
  return true;
}

// When a recording has ended, its last reprocessing may still be running.
void EstimatorNode::catch_up() {
  if (!last_) return;
  auto result = estimator_->catch_up();
  if (!result) return;
  if (stale_) result->estimate = stale(std::move(result->estimate));
  diagnostics_.set("estimate", shown(result->estimate));
  outputs_.publish(*estimator_, *result, *last_, last_stamp_);
  show_state(result->estimate);
}

// Publishes the last estimate as stale when no frame was used for longer than the model allows. It uses the wall clock,
// because a recording that has ended also stops a simulated clock.
void EstimatorNode::mark_stale() {
  if (!last_ || stale_) return;
  const double since = std::chrono::duration<double>(std::chrono::steady_clock::now() - arrival_).count();
  if (since < limits_.stale_after) return;
  stale_ = true;
  const Estimate estimate = stale(estimator_->estimate());
  outputs_.publish(estimate, last_stamp_);
  show_state(estimate);
}

Estimate EstimatorNode::stale(Estimate estimate) const {
  std::ostringstream why;
  why << "no measurement could be used for " << limits_.stale_after << " s";
  if (!why_skipped_.empty()) why << " (" << why_skipped_ << ")";
  if (estimate.state != EstimateState::stale) {
    why << "; the state was " << to_string(estimate.state);
    if (!estimate.state_reason.empty()) why << " (" << estimate.state_reason << ")";
  }
  estimate.state = EstimateState::stale;
  estimate.state_reason = why.str();
  return estimate;
}

void EstimatorNode::show_state(const Estimate& estimate) {
  using State = EstimateState;
  const bool good =
      estimate.state == State::no_data || estimate.state == State::converging || estimate.state == State::converged;
  const std::string why = estimate.state_reason.empty() ? "" : ": " + estimate.state_reason;
  const auto level = estimate.state == State::stale ? DiagnosticStatus::STALE : DiagnosticStatus::WARN;
  diagnostics_.state(good ? DiagnosticStatus::OK : level, to_string(estimate.state) + why);
}

void EstimatorNode::report(const StepResult& result) {
  diagnostics_.set("frames dropped", std::to_string(queue_.dropped()));
  if (queue_.broken_stamps() > 0) {
    diagnostics_.set("broken stamps", std::to_string(queue_.broken_stamps()) + ", last " + queue_.last_broken_stamp());
  }
  for (int k = 0; k < result.repeated; ++k) diagnostics_.count("repeated messages");
  why_skipped_ = result.reason;
  if (!result.used) {
    ROS_WARN_STREAM_THROTTLE(1.0, "frame skipped: " << result.reason);
    diagnostics_.count("frames skipped");
    return diagnostics_.set("last reason for skipping", result.reason);
  }
  diagnostics_.count("frames used");
  diagnostics_.set("estimate", shown(result.estimate));
  if (const auto error = estimator_->basis_error()) diagnostics_.set("basis error [m]", std::to_string(*error));
  for (const auto& [stage, seconds] : result.seconds) diagnostics_.time(stage, seconds);
  show_state(result.estimate);
}

}  // namespace tissue_stiffness
