// The default scheme iterates free-running sigma points. `step` reads: predict, observe, update, reprocess.
#include <algorithm>

#include "estimation/background_reprocessing.hpp"
#include "estimation/change_history.hpp"
#include "estimation/change_watch.hpp"
#include "estimation/hyper_reduction.hpp"
#include "estimation/initial_velocity.hpp"
#include "estimation/posterior.hpp"
#include "estimation/scheme.hpp"
#include "estimation/settling.hpp"
#include "estimation/state_judgement.hpp"
#include "estimation/stopwatch.hpp"
#include "estimation/studies.hpp"
#include "estimation/systematic_error.hpp"
#include "estimation/validity.hpp"
#include "forward/study_model.hpp"
#include "observation/frame_misfit.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVelocityFrames = 4;     // frames that the initial velocity is read from
constexpr double kReplayGrowth = 1.5;  // growth of a replay between reprocessings: nobody reads its estimates on the way
constexpr double kMoved = 0.2;         // standard deviations that a corrected load has to move the estimate by

class UnscentedScheme : public Scheme {
 public:
  UnscentedScheme(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives)
      : Scheme(settings, mesh, relatives), filter_run_(new_filter()), systematic_(*model_), studies_(*model_, relatives) {}

  std::vector<std::string> description() const override {
    const std::string why = studies_.mesh_unknown();
    return {forward_->description(),
            "mesh error: " + (!why.empty()                ? "not assessed, " + why
                              : !studied_in_full(*model_) ? "assessed on its linear form, from a mesh refined eightfold"
                                                          : "from a mesh refined eightfold")};
  }

  std::vector<Misfit> free_run(const FreeFrameVisitor& visit) override {
    stop();
    if (frames_.empty()) return {};
    const Eigen::VectorXd theta = model_->parameters().theta(filter_run_->filter().mean());
    if (change_history_.empty()) return compare_free_run(frames_, filter_run_->start(), theta, visit);
    return compare_free_run(change_history_.all_frames(frames_), {start()}, change_history_.theta(), visit,
                            change_history_.changes(theta));
  }
  std::optional<double> basis_error() const override { return filter_run_->basis_error(); }
  Eigen::MatrixXd parameter_covariance() const override { return systematic_.correct(filtered()).covariance; }

 protected:
  StepResult process(const Frame& frame) override {
    if (model_->settings().initial.kind == InitialSettings::Kind::from_frames && !filter_run_->begun()) {
      return wait_for_velocity(frame);
    }
    return assimilate(frame);
  }

  void stop() override { reprocessing_ = nullptr; }

  bool reprocesses() const override { return reprocessing_ != nullptr || studies_.under_way(); }

  std::optional<StepResult> take_reprocessed() override {
    const bool reprocessed = reprocessing_ && reprocessing_->finished(), studied = studies_.finished();
    if (frames_.empty() || !(reprocessed || studied)) return std::nullopt;
    if (reprocessed) adopt(std::exchange(reprocessing_, nullptr)->take());
    const Frame frame = frames_.back();
    reprocess();
    study();
    StepResult result;
    publish(frame, filter_run_->predict(frame), {}, result);
    return result;
  }

  void forget() override {
    frames_.clear();
    waiting_.clear();
    forward_ = in_full(forward_);  // a hyper-reduced model has to prove itself again
    filter_run_ = new_filter();
    studies_.reset();
    systematic_.reset();
    restudying_ = corrected_ = false;
    settling_ = {};
    frames_at_reprocessing_ = 0;
    complete_ = true;
    change_history_ = {};
    validity_.reset();
    watch_.restart();
  }

 private:
  std::shared_ptr<IteratedFilter> new_filter() const {
    const Eigen::VectorXd std = model_->parameters().prior_std();
    const PosteriorLinearizationFilter prior(model_->parameters().prior_mean(), std.cwiseAbs2().asDiagonal());
    return std::make_shared<IteratedFilter>(*model_, operators_, forward_, prior, RunStart{start()});
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
    model_->parameters().set_velocity_prior(v.mean, v.std);
    StepResult result;
    for (const Frame& kept : waiting_) result = assimilate(kept);
    waiting_.clear();
    return result;
  }

  StepResult assimilate(const Frame& frame) {
    StepResult result;
    Stopwatch watch(result.seconds);
    if (reprocessing_ && reprocessing_->finished()) adopt(std::exchange(reprocessing_, nullptr)->take());
    watch.lap("reprocess");
    extend_output_to(frame);
    begin_if_needed();
    filter_run_->advance(frame.time);
    watch.lap("predict");
    Ensemble::Predicted predicted = filter_run_->predict(frame);
    watch.lap("observe");
    const PosteriorLinearizationFilter::Innovation innovation = filter_run_->absorb(predicted);
    keep(frame);
    watch.lap("update");
    if (reprocess()) predicted = filter_run_->predict(frame);
    watch.lap("reprocess");
    if (study()) predicted = filter_run_->predict(frame);
    watch.lap("studies");
    publish(frame, predicted, innovation, result);
    watch.lap("report");
    return result;
  }

  void begin_if_needed() {
    if (filter_run_->begun()) return;
    filter_run_ = new_filter();  // the start, and the prior of a velocity read from frames, are known now
    if (near() != nullptr) filter_run_->expect(*near());
    filter_run_->begin();
  }

  void keep(const Frame& frame) {
    if (complete_) frames_.push_back(frame);
    if (reprocessing_) reprocessing_->add(frame);
    if (complete_ && frames_.size() + change_history_.frame_count() > window_) change_history_ = {};
  }

  bool overfull() const { return frames_.size() > window_; }

  // Reprocesses the recording where that is due, or to search for a change; in the background when a node runs. Returns
  // true if the runs changed.
  bool reprocess() {
    if (reprocessing_ || !complete_) return false;
    if (overfull()) return reprocess(*filter_run_, frames_, {std::nullopt, frames_.size() / 2});
    if (near() != nullptr && more_follow()) return false;
    if (std::optional<ChangeQuestion> again = change_history_.closer(frames_.size())) {
      return reprocess(change_history_.filter(), change_history_.frames_since_its_start(frames_), {std::move(again)});
    }
    std::optional<ChangeQuestion> question = watch_.due();
    const bool calm = !watch_.suspicious() || watch_.searched();
    const bool too_soon =
        replaying() && more_follow() &&
        static_cast<double>(frames_.size()) < kReplayGrowth * static_cast<double>(frames_at_reprocessing_);
    if (!question && !(calm && !too_soon && filter_run_->wants_relinearization(frames_.size()))) return false;
    frames_at_reprocessing_ = frames_.size();
    return reprocess(*filter_run_, frames_, {std::move(question)});
  }

  bool reprocess(const IteratedFilter& filter, const std::vector<Frame>& frames, BackgroundReprocessing::Task task) {
    if (!hurried())
      return adopt(BackgroundReprocessing::reprocess(filter.clone_unstarted(), frames, std::move(task), [] {}));
    reprocessing_ = std::make_unique<BackgroundReprocessing>(filter, frames, std::move(task));
    return false;
  }

  bool adopt(BackgroundReprocessing::Outcome outcome) {
    const BackgroundReprocessing::Task& task = outcome.task;
    if (!outcome.moved) {
      if (task.roll > 0) stop_keeping();
      if (task.roll == 0 && !task.change) filter_run_->take_notes(*outcome.filter);
      return false;
    }
    if (task.roll > 0) {
      frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(outcome.first));
      change_history_ = {};
    } else if (task.change) {
      change_history_.record_change(*filter_run_, *outcome.filter, outcome.first, *task.change, frames_);
      systematic_.drop_fit();  // because that fit assumed no change
      if (!task.change->near) watch_.go_on();
    }
    filter_run_ = std::move(outcome.filter);
    forward_ = filter_run_->forward();
    return true;
  }

  // From then on the filter only adds information.
  void stop_keeping() {
    complete_ = false;
    frames_.clear();
    change_history_ = {};
  }

  void publish(const Frame& frame, const Ensemble::Predicted& predicted,
               const PosteriorLinearizationFilter::Innovation& innovation, StepResult& result) {
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    const Eigen::VectorXd w = filter.mean();
    prediction_ = predicted.central;
    prediction_.predicted = filter.predict(predicted.rows, w);
    const Eigen::Index points = predicted.rows.cols();
    recover_ = [run = filter_run_, weights = filter.predict(Eigen::MatrixXd::Identity(points, points), w)](
                   Eigen::Ref<Eigen::VectorXd> u) { run->combine(weights, u); };
    if (model_->nonlinear()) displacement();  // now, because a later step may fail half-way
    result.used = true;
    result.misfit = frame_misfit(frame.time, prediction_, at_rest(frame).predicted, model_->mesh().node_count());
    result.misfit.nis = innovation.nis;
    result.misfit.dof = innovation.dof;
    validity_.add(result.misfit);
    watch_.add(result.misfit.rms_sigma * result.misfit.rms_sigma, filter);
    const SystematicError::Filtered now = filtered();
    const SystematicError::Corrected corrected = systematic_.correct(now);
    settling_.add(corrected.mean, corrected.covariance.diagonal().cwiseSqrt());
    StateJudgement judged = judge(result.misfit, now, corrected.covariance);
    estimate_ = summarise_posterior(model_->parameters().free(), corrected.mean, corrected.covariance);
    estimate_.time = frame.time;
    estimate_.state = judged.state;
    estimate_.state_reason = std::move(judged.reason);
    estimate_.variance = corrected.shares;
    if (systematic_.inputs()) estimate_.inputs = systematic_.inputs()->inputs;
    result.estimate = estimate_;
  }

  SystematicError::Filtered filtered() const {
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    return {filter_run_->mean(), filter_run_->covariance(), {filter.misfit_scale(), static_cast<double>(filter.rows())}};
  }

  StateJudgement judge(const Misfit& misfit, const SystematicError::Filtered& now,
                       const Eigen::MatrixXd& covariance) const {
    const bool mesh_pending = !systematic_.mesh_known() && studies_.mesh_unknown().empty() && !more_follow();
    return judge_state({*model_, misfit, now.misfit.scale, systematic_.misfit_has_risen(now.misfit),
                        watch_.suspicious() && !watch_.searched(), validity_.invalid(), stale_load(misfit.time),
                        filter_run_->start().motion != nullptr, restudying_ || systematic_.left_study(now),
                        settling_.settled(), mesh_pending, systematic_, covariance});
  }

  // Studies what the mesh and errors of the inputs do to the estimate, whenever the recording has grown; in the background
  // when a node runs. Returns true if the runs changed.
  bool study() {
    const bool moved = studies_.finished() && take_studies();
    if (studies_.under_way() || more_follow() || filter_run_->start().motion || !complete_) return moved;
    restudying_ = systematic_.left_study(filtered());
    const Studies::Subjects subjects = studies_.due(frames_.size(), restudying_, replaying(), background());
    if (!subjects.any()) return moved;
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    if (subjects.inputs) rows_asked_ = filter.rows();
    studies_.begin({*model_, frames_, filter.mean(), filter.spread(), model_->parameters().prior_std()}, subjects,
                   replaying(), hurried());
    return !hurried() ? take_studies() || moved : moved;
  }

  bool take_studies() {
    Studies::Answers answers = studies_.take();
    if (answers.mesh) systematic_.take_mesh(*answers.mesh, filter_run_->filter().misfit_scale());
    return answers.inputs && take_inputs(std::move(*answers.inputs));
  }

  // A load's estimated error is taken off where it is plausible, leaves a misfit that passes, and moves the estimate. What
  // the runs then still leave to the fit's parameters is a shift. An error that is not believed must not hide the misfit.
  bool take_inputs(InputStudy::Answer answer) {
    systematic_.take_inputs(std::move(answer), rows_asked_);
    const InputStudy::Answer& inputs = *systematic_.inputs();
    restudying_ = false;
    if (!inputs.fitted) return false;
    const Eigen::VectorXd std = filter_run_->covariance().diagonal().cwiseSqrt();
    const Eigen::VectorXd move = inputs.mode - inputs.asked;
    const auto& corrections = inputs.recordings.front().corrections;
    const bool moves = !corrections.empty() && (move.array().abs() > kMoved * std.array()).any();
    const bool believed = systematic_.inputs_believed();
    const bool change = believed ? moves : corrected_;
    if (change) {
      stop();
      for (const auto& [topic, correction] : corrections) {
        model_->loads().courses().at(topic)->correct(correction.basis,
                                                     believed ? correction.coefficients : Eigen::VectorXd());
      }
      corrected_ = believed;
      filter_run_->rerun(frames_, inputs.mode);
      validity_.reset();
    }
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    systematic_.set_runs_at(change ? filter.mean() : inputs.asked, filter.misfit_scale());
    return change;
  }

  std::shared_ptr<IteratedFilter> filter_run_;
  Validity validity_;
  std::vector<Frame> frames_, waiting_;
  ChangeHistory change_history_;
  ChangeWatch watch_{(model_->parameters().drift().array() > 0.0).any()};
  std::size_t window_ = static_cast<std::size_t>(model_->settings().window);
  bool complete_ = true;                                  ///< every frame since the filter's start is in frames_
  std::unique_ptr<BackgroundReprocessing> reprocessing_;  ///< reprocessing under way

  std::size_t frames_at_reprocessing_ = 0;  ///< number of frames at the last reprocessing
  SystematicError systematic_;
  double rows_asked_ = 0.0;  ///< number of rows when the inputs' study was asked for
  bool corrected_ = false;   ///< the loads' estimated errors are taken off
  bool restudying_ = false;  ///< the runs have left the place of the last study
  Settling settling_;
  Studies studies_;  ///< declared last, because its thread reads the model
};

}  // namespace

std::unique_ptr<Scheme> make_unscented_scheme(const ModelSettings& settings, const TetMesh& mesh,
                                              const ReuseSources& relatives) {
  return std::make_unique<UnscentedScheme>(settings, mesh, relatives);
}

}  // namespace tissue_stiffness
