#include "tissue_stiffness/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/identify.hpp"
#include "estimation/scheme.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/repeated_observation.hpp"

namespace tissue_stiffness {
namespace {

using Maker = std::unique_ptr<Scheme> (*)(ObservedBody&, const Pace&, const ReuseSources&);

Maker maker_of(const ModelSettings& settings) {
  static const std::map<std::string, Maker> list = {
#define ESTIMATOR(name) {#name, &make_##name##_scheme},
#include "settings/estimators.def"
#undef ESTIMATOR
  };
  const auto known = list.find(settings.estimator);
  if (known != list.end()) return known->second;
  std::string names;
  for (const auto& [name, maker] : list) names += (names.empty() ? "" : ", ") + name;
  throw InputError(settings.name + ": estimator", settings.estimator, names);
}

}  // namespace

/// It owns body and scheme, and refuses the frames that a scheme must not see.
class Estimator::Implementation {
 public:
  Implementation(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives)
      : body(settings, mesh, relatives), scheme(maker_of(settings)(body, pace, relatives)) {}

  StepResult step(const Frame& frame) {
    if (!holds_repeats(frame)) return step_once(frame);
    Frame once = frame;
    const int repeated = leave_out_repeats(once);
    StepResult result = step_once(once);
    result.repeated = repeated;
    return result;
  }

  StepResult replay(const std::vector<Frame>& frames, const Estimate* near, const std::function<void()>& checkpoint) {
    pace.replaying = true;
    pace.near = near;
    StepResult last;
    for (const Frame& frame : frames) {
      checkpoint();
      pace.more_follow = &frame != &frames.back();
      StepResult result = step(frame);
      if (result.used || !last.used) last = std::move(result);
    }
    end_replay();
    return last;
  }

  std::optional<StepResult> catch_up() {
    try {
      return scheme->take_reprocessed();
    } catch (const std::exception&) {
      return std::nullopt;  // a reprocessing that cannot follow; what is known stays
    }
  }

  void reset() {
    scheme->stop();  // before the loads that its runs read are forgotten
    end_replay();
    last_time_.reset();
    body.forget();
    scheme->reset();
  }

  Pace pace;
  ObservedBody body;
  std::unique_ptr<Scheme> scheme;

 private:
  void end_replay() {
    pace.replaying = false;
    pace.near = nullptr;
  }

  StepResult step_once(const Frame& frame) {
    if (!std::isfinite(frame.time)) return refuse("its time is not a number");
    body.guess_first_stamp(frame.time);
    if (frame.time < body.start()) return refuse("before the body is at rest (time.start)");
    if (last_time_ && frame.time <= *last_time_) return refuse("late: not newer than the frame before");
    try {
      if (!body.sees(frame)) return refuse("nothing was observed");
      const std::string silence = body.model().loads().silence(frame.time);
      if (!silence.empty()) return refuse_silence(frame.time, silence);
      last_time_ = frame.time;
      return scheme->process(frame);
    } catch (const std::exception& error) {
      return refuse(error.what());
    }
  }

  StepResult refuse(const std::string& reason) const {
    StepResult result;
    result.estimate = scheme->last().estimate;
    result.reason = reason;
    return result;
  }

  // The estimate is of the last frame that was used, and says so when that was too long ago.
  StepResult refuse_silence(double time, const std::string& silence) {
    const std::string stale = body.stale_load(time);
    Estimate& estimate = scheme->last().estimate;
    if (!stale.empty() && estimate.state != EstimateState::no_data) {
      estimate.state = EstimateState::stale;
      estimate.state_reason = stale;
    }
    return refuse(silence);
  }

  std::optional<double> last_time_;
};

Estimator::Estimator(const ModelSettings& settings, const TetMesh& mesh) : Estimator(settings, mesh, {}) {}

Estimator::Estimator(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives)
    : implementation_(std::make_unique<Implementation>(settings, mesh, relatives)) {}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

const std::vector<LoadInput>& Estimator::load_inputs() const {
  return implementation_->body.model().loads().inputs();
}
void Estimator::set_first_stamp(double time) {
  implementation_->body.set_first_stamp(time);
}
void Estimator::work_in_background() {
  implementation_->pace.background = true;
}
void Estimator::set_state_limits(const StateLimits& limits) {
  implementation_->body.set_state_limits(limits);
}
void Estimator::add_load(const LoadSample& sample) {
  implementation_->body.add_load(sample);
}
StepResult Estimator::step(const Frame& frame) {
  return implementation_->step(frame);
}
StepResult Estimator::replay(const std::vector<Frame>& frames, const Estimate* near,
                             const std::function<void()>& checkpoint) {
  return implementation_->replay(frames, near, checkpoint);
}
std::optional<StepResult> Estimator::catch_up() {
  return implementation_->catch_up();
}
bool Estimator::reprocesses() const {
  return implementation_->scheme->reprocesses();
}
void Estimator::reset() {
  implementation_->reset();
}
const TetMesh& Estimator::mesh() const {
  return implementation_->body.model().mesh();
}
const Estimate& Estimator::estimate() const {
  return implementation_->scheme->last().estimate;
}
const Eigen::Matrix3Xd& Estimator::displacement() const {
  return implementation_->scheme->last().displacement();
}
const Prediction& Estimator::prediction() const {
  return implementation_->scheme->last().prediction;
}
std::optional<double> Estimator::basis_error() const {
  return implementation_->scheme->basis_error();
}
std::vector<std::string> Estimator::description() const {
  return implementation_->scheme->description();
}
std::vector<Misfit> Estimator::free_run(const FreeFrameVisitor& visit) {
  return implementation_->scheme->free_run(visit);
}

std::map<std::string, Identifiability> Estimator::identifiability() const {
  return identify(implementation_->body.model(), implementation_->scheme->parameter_covariance());
}

}  // namespace tissue_stiffness
