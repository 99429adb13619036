// The default scheme: free-running sigma points, iterated. `step` reads: predict, observe, update, revisit.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include "tissue_stiffness/estimation/aside.hpp"
#include "tissue_stiffness/estimation/change_watch.hpp"
#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/initial_velocity.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/estimation/past.hpp"
#include "tissue_stiffness/estimation/posterior.hpp"
#include "tissue_stiffness/estimation/revisit.hpp"
#include "tissue_stiffness/estimation/scheme.hpp"
#include "tissue_stiffness/estimation/stopwatch.hpp"
#include "tissue_stiffness/estimation/validity.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVelocityFrames = 4;          // frames that the initial velocity is read from
constexpr std::size_t kFirstMeshStudy = 4;  // frames
constexpr double kReplayGrowth = 1.5;       // of a replay between looks back: nobody reads its estimates on the way
constexpr double kConverged = 0.05;         // relative standard deviation
constexpr double kInvalidSigmas = 10.0;     // rms error over noise at which the model says nothing about the body

class UnscentedScheme : public Scheme {
 public:
  UnscentedScheme(const ModelSettings& settings, const TetMesh& mesh, const Relatives& relatives)
      : Scheme(settings, mesh, relatives),
        track_(new_track()),
        unstudied_(MeshError::why_not(*model_)),
        relatives_(relatives) {}

  std::vector<std::string> description() const override {
    const std::string why = unstudied_ + failure_;
    return {forward_->description(),
            "mesh error: " + (!why.empty()          ? "not assessed, " + why
                              : model_->nonlinear() ? "doubted as that of its linear form, from a mesh refined eightfold"
                                                    : "from a mesh refined eightfold")};
  }

  std::vector<Misfit> free_run(const FreeFrameVisitor& visit) override {
    stop();
    if (frames_.empty()) return {};
    const Eigen::VectorXd theta = model_->theta(track_->filter().mean());
    if (past_.empty()) return compare_free_run(frames_, track_->start(), theta, visit);
    return compare_free_run(past_.all_frames(frames_), {start()}, past_.theta(), visit, past_.turns(theta));
  }
  std::optional<double> basis_error() const override { return track_->basis_error(); }
  Eigen::MatrixXd parameter_covariance() const override { return track_->filter().covariance(); }

 protected:
  StepResult process(const Frame& frame) override {
    if (model_->settings().initial.kind == InitialSettings::Kind::from_frames && !track_->begun()) {
      return wait_for_velocity(frame);
    }
    return assimilate(frame);
  }

  void stop() override { revisit_ = nullptr; }

  bool looks_back() const override { return revisit_ != nullptr || study_.valid(); }

  std::optional<StepResult> take_look() override {
    const bool looked = revisit_ && revisit_->finished(), studied = study_is_over();
    if (frames_.empty() || !(looked || studied)) return std::nullopt;
    if (looked) adopt(std::exchange(revisit_, nullptr)->take());
    const Frame frame = frames_.back();
    revisit();
    study_mesh();
    StepResult result;
    publish(frame, track_->predict(frame), {}, result);
    return result;
  }

  void forget() override {
    frames_.clear();
    waiting_.clear();
    track_ = new_track();
    if (study_.valid()) study_.wait();
    study_ = {};
    shift_.resize(0);
    failure_.clear();
    last_study_ = looked_back_ = 0;
    complete_ = true;
    past_ = {};
    validity_.reset();
    watch_.restart();
  }

 private:
  std::shared_ptr<Track> new_track() const {
    const Eigen::VectorXd std = model_->prior_std();
    const AnchoredFilter prior(model_->prior_mean(), std.cwiseAbs2().asDiagonal());
    return std::make_shared<Track>(*model_, operators_, forward_, prior, RunStart{start()});
  }

  StepResult wait_for_velocity(const Frame& frame) {
    waiting_.push_back(frame);
    if (waiting_.size() < kVelocityFrames) {
      StepResult result;
      result.estimate = estimate_;
      result.reason = "kept until the initial velocity can be read";
      return result;
    }
    const VelocityEstimate v = velocity_from_frames(*model_, waiting_);
    model_->set_velocity_prior(v.mean, v.std);
    StepResult result;
    for (const Frame& kept : waiting_) result = assimilate(kept);
    waiting_.clear();
    return result;
  }

  StepResult assimilate(const Frame& frame) {
    StepResult result;
    Stopwatch watch(result.seconds);
    if (revisit_ && revisit_->finished()) adopt(std::exchange(revisit_, nullptr)->take());
    watch.lap("revisit");
    focus_on(frame);
    begin_if_needed();
    track_->advance(frame.time);
    watch.lap("predict");
    Ensemble::Predicted predicted = track_->predict(frame);
    watch.lap("observe");
    const AnchoredFilter::Innovation innovation = track_->absorb(frame, predicted);
    keep(frame);
    watch.lap("update");
    if (revisit()) predicted = track_->predict(frame);
    watch.lap("revisit");
    study_mesh();
    watch.lap("mesh error");
    publish(frame, predicted, innovation, result);
    watch.lap("report");
    return result;
  }

  void begin_if_needed() {
    if (track_->begun()) return;
    track_ = new_track();  // the start, and the prior of a velocity that was read, are known now
    if (near() != nullptr) track_->expect(*near());
    track_->begin();
  }

  void keep(const Frame& frame) {
    if (complete_) frames_.push_back(frame);
    if (revisit_) revisit_->add(frame);
    if (complete_ && frames_.size() + past_.frame_count() > window_) past_ = {};
  }

  bool overfull() const { return frames_.size() > window_; }

  // Looks at the recording again, where that is due, or for a change; in the background when a node runs. True if the runs
  // changed.
  bool revisit() {
    if (revisit_ || !complete_) return false;
    if (overfull()) return look_back(*track_, frames_, {std::nullopt, frames_.size() / 2});
    if (near() != nullptr && more_follow()) return false;
    if (std::optional<ChangeQuestion> again = past_.closer(frames_.size())) {
      return look_back(past_.track(), past_.frames_since_its_start(frames_), {std::move(again)});
    }
    std::optional<ChangeQuestion> question = track_->corrected() ? std::nullopt : watch_.due();
    const bool calm = !watch_.suspicious() || watch_.searched();
    const bool too_soon = replaying() && more_follow() &&
                          static_cast<double>(frames_.size()) < kReplayGrowth * static_cast<double>(looked_back_);
    if (!question && !(calm && !too_soon && track_->wants_look(frames_.size()))) return false;
    looked_back_ = frames_.size();
    return look_back(*track_, frames_, {std::move(question)});
  }

  bool look_back(const Track& track, const std::vector<Frame>& frames, Revisit::Task task) {
    if (!hurried()) return adopt(Revisit::look(track.twin(), frames, std::move(task), [] {}));
    revisit_ = std::make_unique<Revisit>(track, frames, std::move(task));
    return false;
  }

  bool adopt(Revisit::Outcome outcome) {
    const Revisit::Task& task = outcome.task;
    if (!outcome.moved) {
      if (task.roll > 0) stop_keeping();
      if (task.roll == 0 && !task.change) track_->take_notes(*outcome.track);
      return false;
    }
    if (task.roll > 0) {
      frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(outcome.first));
      past_ = {};
    } else if (task.change) {
      past_.turn(*track_, *outcome.track, outcome.first, *task.change, frames_);
      validity_.reset();
      if (!task.change->near) watch_.go_on();
    }
    track_ = std::move(outcome.track);
    forward_ = track_->forward();
    return true;
  }

  // The track then only adds information.
  void stop_keeping() {
    complete_ = false;
    frames_.clear();
    past_ = {};
  }

  void publish(const Frame& frame, const Ensemble::Predicted& predicted, const AnchoredFilter::Innovation& innovation,
               StepResult& result) {
    const AnchoredFilter& filter = track_->filter();
    const Eigen::VectorXd w = filter.mean();
    prediction_ = predicted.central;
    prediction_.predicted = filter.predict(predicted.rows, w);
    const Eigen::Index points = predicted.rows.cols();
    recover_ = [track = track_, weights = filter.predict(Eigen::MatrixXd::Identity(points, points), w)](
                   Eigen::Ref<Eigen::VectorXd> u) { track->combine(weights, u); };
    if (model_->nonlinear()) displacement();  // before a step that fails half-way
    result.used = true;
    result.misfit = compare(frame.time, prediction_, at_rest(frame).predicted, model_->mesh().node_count());
    result.misfit.nis = innovation.nis;
    result.misfit.dof = innovation.dof;
    const Eigen::VectorXd shift = shift_.size() > 0 ? shift_ : Eigen::VectorXd::Zero(w.size());
    const Eigen::VectorXd mean =
        model_->nonlinear() ? w : Eigen::VectorXd(w - shift);  // its linear form's shift corrects nothing
    estimate_ = summarise(model_->free_parameters(), mean, track_->covariance() + mesh_doubt(*model_, shift));
    estimate_.time = frame.time;
    validity_.add(result.misfit);
    watch_.add(result.misfit.rms_sigma * result.misfit.rms_sigma, filter);
    estimate_.state = state(result.misfit);
    result.estimate = estimate_;
  }

  EstimateState state(const Misfit& misfit) const {
    if (misfit.count == 0) return EstimateState::no_data;
    if (watch_.suspicious() && !watch_.searched()) return EstimateState::drifting;
    if (misfit.rms_sigma > kInvalidSigmas) return EstimateState::model_invalid;
    for (std::size_t i = 0; i < estimate_.parameters.size(); ++i) {
      const ParameterEstimate& p = estimate_.parameters[i];
      const bool positive = model_->free_parameters()[i].prior.kind == Quantity::Kind::log_normal;
      const double scale = positive ? std::abs(p.mean) : model_->free_parameters()[i].prior.spread;
      if (p.std > kConverged * scale) return track_->start().motion ? EstimateState::drifting : EstimateState::converging;
    }
    return validity_.invalid() ? EstimateState::model_invalid : EstimateState::converged;
  }

  bool study_is_over() const {
    return study_.valid() && study_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  // What the mesh does to the estimate, asked anew whenever the recording has doubled; in the background when a node runs.
  void study_mesh() {
    if (study_.valid() && (!background() || study_is_over())) {
      try {
        study_.get();
        shift_ = studied_.believed(track_->filter().misfit_scale());
        failure_.clear();
      } catch (const std::exception& error) {
        failure_ = error.what();
      }
    }
    if (study_.valid() || !unstudied_.empty() || more_follow() || track_->start().motion ||
        frames_.size() < std::max(kFirstMeshStudy, 2 * last_study_))
      return;
    last_study_ = frames_.size();
    const AnchoredFilter& filter = track_->filter();
    MeshError::Question question(*model_, frames_, filter.mean(), filter.spread(), model_->prior_std());
    const auto study = [this, once = replaying(), question = std::move(question)] {
      if (once) {
        studied_ = MeshError(*model_, model_->theta(question.w), {}, relatives_).study(question);
        return;
      }
      if (mesh_error_ == nullptr) mesh_error_ = std::make_unique<MeshError>(*model_);
      studied_ = mesh_error_->study(question);
    };
    study_ = background() ? aside(study) : std::async(std::launch::deferred, study);  // with every core
    if (!background()) study_mesh();
  }

  std::shared_ptr<Track> track_;
  Validity validity_;
  std::vector<Frame> frames_, waiting_;
  Past past_;
  ChangeWatch watch_{(model_->drift().array() > 0.0).any()};
  std::size_t window_ = static_cast<std::size_t>(model_->settings().window);
  bool complete_ = true;              ///< every frame since the track's start is in frames_
  std::unique_ptr<Revisit> revisit_;  ///< under way

  std::string unstudied_;  ///< why the mesh's error is not assessed; empty: it is
  const Relatives relatives_;
  std::string failure_;                           ///< of the last study; more frames may settle the next
  std::unique_ptr<MeshError> mesh_error_;         ///< the study's own; only its thread touches it
  MeshError::Answer studied_;                     ///< the same
  Eigen::VectorXd shift_;                         ///< estimate less truth because of the mesh; empty: not known yet
  std::size_t last_study_ = 0, looked_back_ = 0;  ///< frames that there were then
  std::future<void> study_;                       ///< last: its thread uses the members above
};

}  // namespace

std::unique_ptr<Scheme> make_unscented_scheme(const ModelSettings& settings, const TetMesh& mesh,
                                              const Relatives& relatives) {
  return std::make_unique<UnscentedScheme>(settings, mesh, relatives);
}

}  // namespace tissue_stiffness
