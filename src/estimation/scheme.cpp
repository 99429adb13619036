#include "estimation/scheme.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "estimation/posterior.hpp"
#include "fit/ensemble.hpp"
#include "forward/reduced_model.hpp"
#include "observation/frame_misfit.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/repeated_observation.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kManyNodes = 10000;  // nodes beyond which every vector of the basis delays the first estimate noticeably
constexpr int kFewVectors = 24;    // vectors to start with there; the basis grows when that is not enough

}  // namespace

Scheme::Scheme(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives)
    : model_(relatives.own != nullptr ? std::make_unique<Model>(settings, relatives.own->model())
                                      : std::make_unique<Model>(settings, mesh)),
      operators_(make_observation_operators(*model_)) {
  if (model_->parameters().free().empty()) {
    throw InputError(settings.name + ": effects", "only known numbers", "at least one {prior, factor} or {mean, std}");
  }
  if (operators_.empty()) throw InputError(settings.name + ": observations", "an empty list", "at least one entry");
  BasisOptions basis;
  if (mesh.node_count() > kManyNodes) basis.size = kFewVectors;
  basis.keep_root = relatives.own != nullptr;
  forward_ = make_forward_model(*model_, basis, relatives.own);
  displacement_ = Eigen::Matrix3Xd::Zero(3, mesh.node_count());
  const Eigen::VectorXd std = model_->parameters().prior_std();
  estimate_ =
      summarise_posterior(model_->parameters().free(), model_->parameters().prior_mean(), std.cwiseAbs2().asDiagonal());
}

const Eigen::Matrix3Xd& Scheme::displacement() const {
  if (recover_) {
    recover_(Eigen::Map<Eigen::VectorXd>(displacement_.data(), displacement_.size()));
    recover_ = nullptr;
  }
  return displacement_;
}

void Scheme::extend_output_to(const Frame& frame) {
  const int count = model_->mesh().node_count();
  bool more = false;
  if (seen_nodes_.empty()) seen_nodes_.assign(static_cast<std::size_t>(count), 0);
  for (const Observation& observation : frame.observations) {
    for (const int node : operators_[static_cast<std::size_t>(observation.source)]->nodes(observation)) {
      char& seen = seen_nodes_[static_cast<std::size_t>(node)];
      more = more || seen == 0;
      seen = 1;
    }
  }
  if (!more) return;
  std::vector<int> nodes;
  for (int node = 0; node < count; ++node) {
    if (seen_nodes_[static_cast<std::size_t>(node)] != 0) nodes.push_back(node);
  }
  stop();
  forward_->restrict_output_to(nodes);
}

void Scheme::set_first_stamp(double time) {
  first_stamp_ = time;
  model_->loads().set_first_stamp(time);
}

void Scheme::add_load(const LoadSample& sample) {
  const auto course = model_->loads().courses().find(sample.topic);
  if (course == model_->loads().courses().end()) return;
  if (!sample.value.allFinite() || sample.value.size() != course->second->components()) {
    throw InputError(sample.topic, "a load that is not finite or has the wrong size",
                     std::to_string(course->second->components()) + " finite number(s)");
  }
  if (!std::isfinite(sample.time)) throw InputError(sample.topic, "a load without a time", "a finite time [s]");
  course->second->add(sample.time, sample.value);
  first_load_ = std::min(first_load_, sample.time);
}

StepResult Scheme::step(const Frame& frame) {
  if (!holds_repeats(frame)) return step_once(frame);
  Frame once = frame;
  const int repeated = leave_out_repeats(once);
  StepResult result = step_once(once);
  result.repeated = repeated;
  return result;
}

StepResult Scheme::step_once(const Frame& frame) {
  StepResult result;
  result.estimate = estimate_;
  const auto refuse = [&result](const std::string& reason) {
    result.reason = reason;
    return result;
  };
  if (!std::isfinite(frame.time)) return refuse("its time is not a number");
  if (!first_stamp_) set_first_stamp(std::min(frame.time, first_load_));
  if (frame.time < start()) return refuse("before the body is at rest (time.start)");
  if (last_time_ && frame.time <= *last_time_) return refuse("late: not newer than the frame before");
  try {
    if (!seen(frame)) return refuse("nothing was observed");
    const std::string silence = model_->loads().silence(frame.time);
    if (!silence.empty()) return refuse_silence(frame.time, silence);
    last_time_ = frame.time;
    return process(frame);
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

// The estimate is of the last frame that was used, and says so when that was too long ago.
StepResult Scheme::refuse_silence(double time, const std::string& silence) {
  const std::string stale = stale_load(time);
  if (!stale.empty() && estimate_.state != EstimateState::no_data) {
    estimate_.state = EstimateState::stale;
    estimate_.state_reason = stale;
  }
  StepResult result;
  result.estimate = estimate_;
  result.reason = silence;
  return result;
}

std::optional<StepResult> Scheme::catch_up() {
  try {
    return take_reprocessed();
  } catch (const std::exception&) {
    return std::nullopt;  // a reprocessing that cannot follow; what is known stays
  }
}

StepResult Scheme::replay(const std::vector<Frame>& frames, const Estimate* near, const std::function<void()>& checkpoint) {
  replaying_ = true;
  near_ = near;
  StepResult last;
  for (const Frame& frame : frames) {
    checkpoint();
    more_follow_ = &frame != &frames.back();
    StepResult result = step(frame);
    if (result.used || !last.used) last = std::move(result);
  }
  replaying_ = false;
  near_ = nullptr;
  return last;
}

bool Scheme::seen(const Frame& frame) const {
  bool any = false;
  for (const Observation& observation : frame.observations) {
    const auto source = static_cast<std::size_t>(observation.source);
    if (source >= operators_.size()) {
      throw InputError("observations", "entry " + std::to_string(observation.source),
                       "0 to " + std::to_string(operators_.size() - 1));
    }
    operators_[source]->check(observation);
    any = observation.holds_anything() || any;
  }
  return any;
}

void Scheme::reset() {
  stop();
  replaying_ = false;
  near_ = nullptr;
  last_time_.reset();
  first_stamp_.reset();
  first_load_ = INFINITY;
  model_->parameters().forget_velocity_prior();
  for (auto& course : model_->loads().courses()) course.second->clear();
  const Eigen::VectorXd std = model_->parameters().prior_std();
  estimate_ =
      summarise_posterior(model_->parameters().free(), model_->parameters().prior_mean(), std.cwiseAbs2().asDiagonal());
  recover_ = nullptr;
  displacement_.setZero();
  prediction_ = {};
  forget();
}

std::string Scheme::stale_load(double time) const {
  const double longest = model_->settings().stale_after;
  for (const LoadInput& input : model_->loads().inputs()) {
    const std::optional<double> last = model_->loads().courses().at(input.topic)->last();
    const double since = time - last.value_or(start());
    if (since <= longest) continue;
    std::ostringstream text;
    text << "no load has come on " << input.topic << (last ? " for " : " in ") << std::setprecision(3) << since << " s";
    return text.str();
  }
  return "";
}

Prediction Scheme::at_rest(const Frame& frame) const {
  return predict_at_rest(*model_, operators_, frame);
}

std::vector<Misfit> Scheme::compare_free_run(const std::vector<Frame>& frames, const RunStart& start,
                                             const Eigen::VectorXd& theta, const FreeFrameVisitor& visit,
                                             const std::vector<ParameterChange>& changes) {
  forward_->restrict_output_to({});
  auto misfits = tissue_stiffness::free_run({*model_, *forward_, operators_, frames, start}, theta, visit, changes);
  seen_nodes_.clear();  // the next frame restricts the output again
  return misfits;
}

}  // namespace tissue_stiffness
