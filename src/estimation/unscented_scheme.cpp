// The default scheme iterates free-running sigma points. `assimilate` reads: predict, observe, update, reprocess, study.
#include "estimation/hyper_reduction.hpp"
#include "estimation/initial_velocity.hpp"
#include "estimation/posterior.hpp"
#include "estimation/reprocessing.hpp"
#include "estimation/scheme.hpp"
#include "estimation/settling.hpp"
#include "estimation/state_judgement.hpp"
#include "estimation/stopwatch.hpp"
#include "estimation/studies.hpp"
#include "estimation/systematic_error.hpp"
#include "estimation/validity.hpp"
#include "forward/study_model.hpp"
#include "observation/frame_misfit.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVelocityFrames = 4;  // frames that the initial velocity is read from
constexpr double kMoved = 0.2;      // standard deviations that a corrected load has to move the estimate by

class UnscentedScheme : public Scheme {
 public:
  UnscentedScheme(ObservedBody& body, const Pace& pace, const ReuseSources& relatives)
      : Scheme(body, pace),
        filter_run_(new_filter()),
        reprocessing_(model_),
        systematic_(model_),
        studies_(model_, relatives) {}

  StepResult process(const Frame& frame) override {
    const bool velocity_wanted = model_.settings().initial.kind == InitialSettings::Kind::from_frames;
    return velocity_wanted && !filter_run_->begun() ? wait_for_velocity(frame) : assimilate(frame);
  }

  std::optional<StepResult> take_reprocessed() override {
    if (reprocessing_.frames().empty() || !(reprocessing_.finished() || studies_.finished())) return std::nullopt;
    const Frame frame = reprocessing_.frames().back();  // a round may end with none kept
    follow(reprocessing_.take_finished(filter_run_));
    follow(reprocessing_.run(filter_run_, pace_));
    study();
    StepResult result;
    publish(frame, filter_run_->predict(frame), {}, result);
    return result;
  }
  bool reprocesses() const override { return reprocessing_.under_way() || studies_.under_way(); }
  void stop() override { reprocessing_.stop(); }

  Eigen::MatrixXd parameter_covariance() const override { return systematic_.correct(filtered()).covariance; }
  std::vector<std::string> description() const override {
    const std::string why = studies_.mesh_unknown();
    return {body_.forward()->description(),
            "mesh error: " + (!why.empty()               ? "not assessed, " + why
                              : !studied_in_full(model_) ? "assessed on its linear form, from a mesh refined eightfold"
                                                         : "from a mesh refined eightfold")};
  }
  std::optional<double> basis_error() const override { return filter_run_->basis_error(); }
  std::vector<Misfit> free_run(const FreeFrameVisitor& visit) override {
    stop();
    const std::vector<Frame>& frames = reprocessing_.frames();
    if (frames.empty()) return {};
    const ChangeHistory& history = reprocessing_.history();
    const Eigen::VectorXd theta = model_.parameters().theta(filter_run_->filter().mean());
    if (history.empty()) return body_.compare_free_run(frames, filter_run_->start(), theta, visit);
    return body_.compare_free_run(history.all_frames(frames), {body_.start()}, history.theta(), visit,
                                  history.changes(theta));
  }

 protected:
  void forget() override {
    waiting_.clear();
    reprocessing_.forget();
    body_.set_forward(in_full(body_.forward()));  // a hyper-reduced model has to prove itself again
    filter_run_ = new_filter();
    studies_.reset();
    systematic_.reset();
    restudying_ = corrected_ = false;
    settling_ = {};
    validity_.reset();
  }

 private:
  std::shared_ptr<IteratedFilter> new_filter() const {
    const Eigen::VectorXd std = model_.parameters().prior_std();
    const PosteriorLinearizationFilter prior(model_.parameters().prior_mean(), std.cwiseAbs2().asDiagonal());
    return std::make_shared<IteratedFilter>(model_, body_.operators(), body_.forward(), prior, RunStart{body_.start()});
  }

  StepResult wait_for_velocity(const Frame& frame) {
    waiting_.push_back(frame);
    if (waiting_.size() < kVelocityFrames) {
      StepResult result;
      result.estimate = last_.estimate;
      result.reason = "kept until the initial velocity can be read";
      return result;
    }
    const VelocityEstimate v = velocity_from_frames(model_, waiting_);
    model_.parameters().set_velocity_prior(v.mean, v.std);
    StepResult result;
    for (const Frame& kept : waiting_) result = assimilate(kept);
    waiting_.clear();
    return result;
  }

  StepResult assimilate(const Frame& frame) {
    StepResult result;
    Stopwatch watch(result.seconds);
    follow(reprocessing_.take_finished(filter_run_));
    watch.lap("reprocess");
    extend_output_to(frame);
    begin_if_needed();
    filter_run_->advance(frame.time);
    watch.lap("predict");
    Ensemble::Predicted predicted = filter_run_->predict(frame);
    watch.lap("observe");
    const PosteriorLinearizationFilter::Innovation innovation = filter_run_->absorb(predicted);
    reprocessing_.keep(frame);
    watch.lap("update");
    if (follow(reprocessing_.run(filter_run_, pace_))) predicted = filter_run_->predict(frame);
    watch.lap("reprocess");
    if (study()) predicted = filter_run_->predict(frame);
    watch.lap("studies");
    publish(frame, predicted, innovation, result);
    watch.lap("report");
    return result;
  }

  void extend_output_to(const Frame& frame) {
    if (!body_.note_nodes_of(frame)) return;
    stop();
    body_.extend_output();
  }

  void begin_if_needed() {
    if (filter_run_->begun()) return;
    filter_run_ = new_filter();  // the start, and the prior of a velocity read from frames, are known now
    if (pace_.near != nullptr) filter_run_->expect(*pace_.near);
    filter_run_->begin();
  }

  // Follows the filter that a round over the frames has left. Returns true if its runs changed.
  bool follow(Reprocessing::Result round) {
    if (round == Reprocessing::Result::unchanged) return false;
    if (round == Reprocessing::Result::changed) systematic_.drop_fit();  // because that fit assumed no change
    body_.set_forward(filter_run_->forward());
    return true;
  }

  void publish(const Frame& frame, const Ensemble::Predicted& predicted,
               const PosteriorLinearizationFilter::Innovation& innovation, StepResult& result) {
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    const Eigen::VectorXd w = filter.mean();
    last_.prediction = predicted.central;
    last_.prediction.predicted = filter.predict(predicted.rows, w);
    const Eigen::Index points = predicted.rows.cols();
    last_.set_displacement([run = filter_run_, weights = filter.predict(Eigen::MatrixXd::Identity(points, points), w)](
                               Eigen::Ref<Eigen::VectorXd> u) { run->combine(weights, u); });
    if (model_.nonlinear()) last_.displacement();  // now, because a later step may fail half-way
    result.used = true;
    result.misfit = frame_misfit(frame.time, last_.prediction, body_.at_rest(frame).predicted, model_.mesh().node_count());
    result.misfit.nis = innovation.nis;
    result.misfit.dof = innovation.dof;
    validity_.add(result.misfit);
    reprocessing_.watch(result.misfit.rms_sigma * result.misfit.rms_sigma, filter);
    const SystematicError::Filtered now = filtered();
    const SystematicError::Corrected corrected = systematic_.correct(now);
    settling_.add(corrected.mean, corrected.covariance.diagonal().cwiseSqrt());
    StateJudgement judged = judge(result.misfit, now, corrected.covariance);
    Estimate& estimate = last_.estimate;
    estimate = summarise_posterior(model_.parameters().free(), corrected.mean, corrected.covariance);
    estimate.time = frame.time;
    estimate.state = judged.state;
    estimate.state_reason = std::move(judged.reason);
    estimate.variance = corrected.shares;
    if (systematic_.inputs()) estimate.inputs = systematic_.inputs()->inputs;
    result.estimate = estimate;
  }

  SystematicError::Filtered filtered() const {
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    return {filter_run_->mean(), filter_run_->covariance(), {filter.misfit_scale(), static_cast<double>(filter.rows())}};
  }

  StateJudgement judge(const Misfit& misfit, const SystematicError::Filtered& now,
                       const Eigen::MatrixXd& covariance) const {
    const bool mesh_pending = !systematic_.mesh_known() && studies_.mesh_unknown().empty() && !pace_.more_follow;
    return judge_state({model_, misfit, now.misfit.scale, systematic_.misfit_has_risen(now.misfit),
                        reprocessing_.change_suspected(), validity_.invalid(), body_.stale_load(misfit.time),
                        filter_run_->start().motion != nullptr, restudying_ || systematic_.left_study(now),
                        settling_.settled(), mesh_pending, body_.state_limits().converged_within, systematic_, covariance});
  }

  // Studies what the mesh and errors of the inputs do to the estimate, whenever the recording has grown; in the background
  // when a node runs. Returns true if the runs changed.
  bool study() {
    const bool moved = studies_.finished() && take_studies();
    if (studies_.under_way() || pace_.more_follow || filter_run_->start().motion || !reprocessing_.complete()) return moved;
    restudying_ = systematic_.left_study(filtered());
    const std::vector<Frame>& frames = reprocessing_.frames();
    const Studies::Subjects subjects = studies_.due(frames.size(), restudying_, pace_.replaying, pace_.background);
    if (!subjects.any()) return moved;
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    if (subjects.inputs) misfit_asked_ = filtered().misfit;
    studies_.begin({model_, frames, filter.mean(), filter.spread(), model_.parameters().prior_std()}, subjects,
                   pace_.replaying, pace_.hurried());
    return !pace_.hurried() ? take_studies() || moved : moved;
  }

  bool take_studies() {
    Studies::Answers answers = studies_.take();
    if (answers.mesh) systematic_.take_mesh(*answers.mesh, filter_run_->filter().misfit_scale());
    return answers.inputs && take_inputs(std::move(*answers.inputs));
  }

  // A load's estimated error is taken off where it is plausible, leaves a misfit that passes, and moves the estimate. What
  // the runs then still leave to the fit's parameters is a shift. An error that is not believed must not hide the misfit.
  bool take_inputs(InputStudy::Answer answer) {
    systematic_.take_inputs(std::move(answer), misfit_asked_.rows);
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
        model_.loads().courses().at(topic)->correct(correction.basis,
                                                    believed ? correction.coefficients : Eigen::VectorXd());
      }
      corrected_ = believed;
      filter_run_->rerun(reprocessing_.frames(), inputs.mode);
      validity_.reset();
    }
    const PosteriorLinearizationFilter& filter = filter_run_->filter();
    if (change)
      systematic_.set_runs_at(filter.mean(), filter.misfit_scale());
    else
      systematic_.set_runs_at(inputs.asked, misfit_asked_.scale);
    return change;
  }

  std::vector<Frame> waiting_;  ///< until the initial velocity can be read
  std::shared_ptr<IteratedFilter> filter_run_;
  Reprocessing reprocessing_;
  SystematicError systematic_;
  Validity validity_;
  Settling settling_;
  SystematicError::FilteredMisfit misfit_asked_;  ///< when the inputs' study was asked for
  bool corrected_ = false;                        ///< the loads' estimated errors are taken off
  bool restudying_ = false;                       ///< the runs have left the place of the last study
  Studies studies_;                               ///< declared last, because its thread reads the model
};

}  // namespace

std::unique_ptr<Scheme> make_unscented_scheme(ObservedBody& body, const Pace& pace, const ReuseSources& relatives) {
  return std::make_unique<UnscentedScheme>(body, pace, relatives);
}

}  // namespace tissue_stiffness
