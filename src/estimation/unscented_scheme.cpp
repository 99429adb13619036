// The default scheme: free-running sigma points, iterated. `step` reads: predict, observe, update, revisit.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>

#include "tissue_stiffness/estimation/aside.hpp"
#include "tissue_stiffness/estimation/change_watch.hpp"
#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/initial_velocity.hpp"
#include "tissue_stiffness/estimation/input_study.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/estimation/past.hpp"
#include "tissue_stiffness/estimation/posterior.hpp"
#include "tissue_stiffness/estimation/revisit.hpp"
#include "tissue_stiffness/estimation/scheme.hpp"
#include "tissue_stiffness/estimation/settling.hpp"
#include "tissue_stiffness/estimation/stopwatch.hpp"
#include "tissue_stiffness/estimation/validity.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVelocityFrames = 4;           // frames that the initial velocity is read from
constexpr std::size_t kFirstMeshStudy = 4;   // frames
constexpr double kReplayGrowth = 1.5;        // of a replay between looks back: nobody reads its estimates on the way
constexpr double kInputGrowth = 1.5;         // of the recording between studies of the inputs' errors
constexpr double kMoved = 0.2;               // standard deviations: what a corrected load has to move the estimate by
constexpr double kLearnt = 0.5;              // of the prior's standard deviation: what a settled estimate may have left
constexpr double kWidest = 0.2;              // relative standard deviation of an estimate that is called converged
constexpr double kFinerLeaves = 16.0 / 9.0;  // of the mean square that the finer mesh changes: at second order, the whole
constexpr std::size_t kFirstInputs = 4;      // frames before the first study of the inputs' errors
constexpr double kFullSigmas = 1.5;          // rms error over noise that passes where the misfit's shape is not tested
constexpr double kInvalidScale = 4.0;        // mean square of the same over all frames, under the present parameters
constexpr double kInvalidSigmas = 10.0;      // rms error over noise at which the model says nothing about the body

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
  Eigen::MatrixXd parameter_covariance() const override { return covariance(); }

 protected:
  StepResult process(const Frame& frame) override {
    if (model_->settings().initial.kind == InitialSettings::Kind::from_frames && !track_->begun()) {
      return wait_for_velocity(frame);
    }
    return assimilate(frame);
  }

  void stop() override { revisit_ = nullptr; }

  bool looks_back() const override { return revisit_ != nullptr || study_.valid() || input_work_.valid(); }

  std::optional<StepResult> take_look() override {
    const bool looked = revisit_ && revisit_->finished(), studied = is_over(study_) || is_over(input_work_);
    if (frames_.empty() || !(looked || studied)) return std::nullopt;
    if (looked) adopt(std::exchange(revisit_, nullptr)->take());
    const Frame frame = frames_.back();
    revisit();
    study_inputs();
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
    if (input_work_.valid()) input_work_.wait();
    input_work_ = {};
    inputs_.reset();
    restudying_ = corrected_ = false;
    input_shift_.resize(0);
    mesh_left_.reset();
    settling_ = {};
    last_inputs_ = 0;
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
    const AnchoredFilter::Innovation innovation = track_->absorb(predicted);
    keep(frame);
    watch.lap("update");
    if (revisit()) predicted = track_->predict(frame);
    watch.lap("revisit");
    if (study_inputs()) predicted = track_->predict(frame);
    watch.lap("input errors");
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
    std::optional<ChangeQuestion> question = watch_.due();
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
      if (inputs_) inputs_->fitted = false;  // its fit was one without a change
      input_shift_.resize(0);
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
    validity_.add(result.misfit);
    watch_.add(result.misfit.rms_sigma * result.misfit.rms_sigma, filter);
    settling_.add(published_mean(), covariance().diagonal().cwiseSqrt());
    std::string why;
    const EstimateState now = state(result.misfit, why);
    estimate_ = summarise(model_->free_parameters(), published_mean(), covariance());
    estimate_.time = frame.time;
    estimate_.state = now;
    estimate_.state_reason = std::move(why);
    estimate_.variance = variance_shares();
    if (inputs_) estimate_.inputs = inputs_->inputs;
    result.estimate = estimate_;
  }

  Eigen::VectorXd mesh_shift() const {
    return shift_.size() > 0 ? shift_ : Eigen::VectorXd::Zero(track_->filter().mean().size());
  }

  // Of a nonlinear model the mesh's shift is that of its linear form, which corrects nothing.
  Eigen::VectorXd published_mean() const {
    Eigen::VectorXd mean = track_->filter().mean();
    if (!model_->nonlinear()) mean -= mesh_shift();
    if (input_shift_.size() > 0 && inputs_believed()) mean += input_shift_;
    return mean;
  }

  /// Covariance by where it comes from, in the filter's coordinates.
  struct Parts {
    Eigen::MatrixXd noise, mesh, loads, constants, model;
    Eigen::MatrixXd beside_model() const { return noise + mesh + loads + constants; }
    Eigen::MatrixXd all() const { return beside_model() + model; }
  };
  Parts covariance_parts() const {
    const Eigen::MatrixXd noise = track_->covariance(), zero = Eigen::MatrixXd::Zero(noise.rows(), noise.cols());
    Parts parts{noise, mesh_doubt(*model_, mesh_shift()), zero, zero, zero};
    if (!inputs_) {  // nothing is known yet of what the inputs' errors do
      if (!model_->settings().exact_inputs) parts.loads = model_->prior_std().cwiseAbs2().asDiagonal();
      return parts;
    }
    parts.loads = inputs_->from_loads;
    if (input_shift_.size() > 0 && !inputs_believed()) parts.loads += input_shift_ * input_shift_.transpose();
    parts.constants = inputs_->from_constants;
    // The misfit may lie along what the parameters do, with all rows and frames alike (Kennedy & O'Hagan 2001).
    parts.model = within_prior(std::max(misfit_test().discrepancy(), unexplained()) * inputs_->rows * inputs_->from_noise);
    return parts;
  }

  // Beside a misfit that does not pass, or has risen since it was tested, no interval is tighter than that misfit allows,
  // whatever the state: mean square of all frames' misfit under the present parameters beyond noise and mesh, in noise
  // variances.
  double unexplained() const {
    const MisfitTest test = misfit_test();
    const double scale = track_->filter().misfit_scale(), tested = inputs_->fitted ? scale_then_ : 1.0;
    const bool passes = inputs_->implausible.empty() && (!inputs_->fitted || test.passes());
    if (passes && scale <= kFullSigmas * kFullSigmas * tested) return 0.0;
    return std::max(0.0, scale - test.noise_level() - of_mesh());
  }

  /// (C^-1 + P^-1)^-1: whatever is left open, the prior P still holds.
  Eigen::MatrixXd within_prior(const Eigen::MatrixXd& c) const {
    const Eigen::MatrixXd prior = model_->prior_std().cwiseAbs2().asDiagonal();
    return prior * (prior + c).ldlt().solve(c);
  }

  Eigen::MatrixXd covariance() const { return covariance_parts().all(); }

  std::vector<VarianceShares> variance_shares() const {
    const Parts parts = covariance_parts();
    const Eigen::VectorXd all = parts.all().diagonal();
    std::vector<VarianceShares> out;
    for (Eigen::Index i = 0; i < all.size(); ++i) {
      out.push_back({parts.noise(i, i) / all[i], parts.mesh(i, i) / all[i], parts.loads(i, i) / all[i],
                     parts.constants(i, i) / all[i], parts.model(i, i) / all[i]});
    }
    return out;
  }

  // Whether the estimated errors of the inputs are plausible and leave a misfit that passes. If not, the estimate is that
  // under the inputs as they are, and its distance from the fit beside their errors is part of its doubt.
  bool inputs_believed() const { return inputs_->implausible.empty() && misfit_test().passes(); }

  MisfitTest misfit_test() const {
    MisfitTest test = inputs_->test;
    test.set_numerics(of_mesh());
    return test;
  }

  /// Mean square over the noise's that the mesh may leave.
  double of_mesh() const { return kFinerLeaves * mesh_left_.value_or(0.0); }

  // Indices of the parameters that a state speaks of: the moduli, or all where none is free.
  std::vector<Eigen::Index> judged() const {
    std::vector<Eigen::Index> moduli, all;
    for (std::size_t i = 0; i < model_->free_parameters().size(); ++i) {
      all.push_back(static_cast<Eigen::Index>(i));
      if (is_young_modulus(model_->free_parameters()[i].name)) moduli.push_back(all.back());
    }
    return moduli.empty() ? all : moduli;
  }

  // Why the estimate is not precise enough to be used; empty: it is.
  std::string unlearnt() const {
    const Eigen::VectorXd std = covariance().diagonal().cwiseSqrt(), prior = model_->prior_std();
    for (const Eigen::Index i : judged()) {
      const FreeParameter& free = model_->free_parameters()[static_cast<std::size_t>(i)];
      const bool positive = free.prior.kind == Quantity::Kind::log_normal;
      if (std[i] > kLearnt * prior[i]) return free.name + " is hardly better known than its prior";
      if (positive && std[i] > kWidest) return free.name + " is known to " + percent(std[i]) + " only";
    }
    return "";
  }

  static std::string percent(double share) { return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %"; }

  EstimateState state(const Misfit& misfit, std::string& why) const {
    if (misfit.count == 0) return why = "nothing was observed", EstimateState::no_data;
    if (watch_.suspicious() && !watch_.searched()) {
      return why = "the misfit has risen, as it does when a parameter changes", EstimateState::drifting;
    }
    if (misfit.rms_sigma > kInvalidSigmas || (validity_.invalid() && track_->filter().misfit_scale() > kInvalidScale)) {
      return why = "no value of the parameters explains the motion", EstimateState::model_invalid;
    }
    if (why = stale_load(misfit.time); !why.empty()) return EstimateState::stale;
    const EstimateState unknown = track_->start().motion ? EstimateState::drifting : EstimateState::converging;
    if (!inputs_) return why = "the errors of the inputs have not been studied yet", EstimateState::converging;
    if (restudying_ || left_study()) return why = "the errors of the inputs are studied anew", EstimateState::converging;
    if (!settling_.settled()) return why = "the estimate still moves out of its own interval", unknown;
    if (!inputs_->implausible.empty()) return why = inputs_->implausible, EstimateState::doubtful;
    std::string verdict;
    const EstimateState of_misfit = inputs_->fitted ? state_of_misfit(verdict) : state_of_rms(misfit, verdict);
    if (of_misfit == EstimateState::doubtful) return why = verdict, of_misfit;
    if (why = unlearnt(); !why.empty()) return unknown;
    return why = verdict, of_misfit;
  }

  EstimateState state_of_misfit(std::string& why) const {
    const MisfitTest test = misfit_test();
    if (test.passes()) return why = "the misfit is noise", EstimateState::converged;
    if (!mesh_left_ && unstudied_.empty() && failure_.empty() && !more_follow()) {
      return why = "the error of the mesh has not been studied yet", EstimateState::converging;
    }
    char text[200];
    std::snprintf(text, sizeof text,
                  "along the body's lowest modes the misfit is %.2g times the noise's variance, %.1f standard deviations "
                  "beyond what passes",
                  1.0 + test.excess(), test.z());
    return why = text, EstimateState::doubtful;
  }

  // A model that runs in full is judged by the size of its misfit alone.
  EstimateState state_of_rms(const Misfit& misfit, std::string& why) const {
    if (std::pow(misfit.rms_sigma, 2) <= std::pow(kFullSigmas, 2) + of_mesh())
      return why = "the misfit is about the noise", EstimateState::converged;
    char text[100];
    std::snprintf(text, sizeof text, "the misfit is %.2g times the noise", misfit.rms_sigma);
    return why = text, EstimateState::doubtful;
  }

  static bool is_over(const std::future<void>& work) {
    return work.valid() && work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  // What errors of the inputs do to the estimate, asked anew whenever the recording has grown; in the background when a
  // node runs. True if the runs changed.
  bool study_inputs() {
    bool moved = false;
    if (is_over(input_work_)) {
      try {
        input_work_.get();
        moved = take_inputs();
      } catch (const std::exception&) {
        // The last answer stays; more frames may settle the next.
      }
    }
    if (input_work_.valid() || more_follow() || track_->start().motion || !complete_) return moved;
    const bool grown = static_cast<double>(frames_.size()) >=
                       std::max<double>(kFirstInputs, kInputGrowth * static_cast<double>(last_inputs_));
    restudying_ = left_study();
    if (!grown && !restudying_) return moved;
    last_inputs_ = frames_.size();
    const AnchoredFilter& filter = track_->filter();
    studied_at_ = filter.mean();
    scale_then_ = filter.misfit_scale();
    MeshError::Question question(*model_, frames_, filter.mean(), filter.spread(), model_->prior_std());
    const auto work = [this, question = std::move(question)] {
      if (input_study_ == nullptr) input_study_ = std::make_unique<InputStudy>(*model_);
      studied_inputs_ = input_study_->study(question);
    };
    if (hurried()) {
      input_work_ = aside(work);
      return moved;
    }
    try {
      work();
      return take_inputs() || moved;
    } catch (const NumericalError&) {
      return moved;
    }
  }

  // A load's estimated error is taken off where it is plausible, leaves a misfit that passes, and moves the estimate; what
  // the runs then still leave to the fit's parameters is a shift. An error that is not believed must not hide the misfit.
  bool take_inputs() {
    inputs_ = std::move(studied_inputs_);
    restudying_ = false;
    if (!inputs_->fitted) return false;
    const Eigen::VectorXd std = track_->covariance().diagonal().cwiseSqrt();
    const Eigen::VectorXd move = inputs_->w - inputs_->asked;
    const bool moves = !inputs_->corrections.empty() && (move.array().abs() > kMoved * std.array()).any();
    const bool believed = inputs_believed();
    const bool change = believed ? moves : corrected_;
    if (change) {
      stop();
      for (const auto& [topic, correction] : inputs_->corrections) {
        model_->courses().at(topic)->correct(correction.basis, believed ? correction.coefficients : Eigen::VectorXd());
      }
      corrected_ = believed;
      track_->rerun(frames_, inputs_->w);
      validity_.reset();
    }
    studied_at_ = change ? track_->filter().mean() : inputs_->asked;
    input_shift_ = inputs_->w - studied_at_;
    return change;
  }

  // Whether the runs have left the place where the inputs were studied.
  bool left_study() const {
    if (!inputs_ || !inputs_->fitted || input_shift_.size() == 0) return false;
    const Eigen::ArrayXd moved = track_->filter().mean() - studied_at_;
    return (moved.abs() > covariance_parts().beside_model().diagonal().array().sqrt()).any();
  }

  // What the mesh does to the estimate, asked anew whenever the recording has doubled; in the background when a node runs.
  void study_mesh() {
    if (study_.valid() && (!background() || is_over(study_))) {
      try {
        study_.get();
        shift_ = studied_.believed(track_->filter().misfit_scale());
        mesh_left_ = studied_.left;
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
  std::optional<double> mesh_left_;               ///< mean square that the mesh leaves; empty: not known yet
  std::unique_ptr<InputStudy> input_study_;       ///< only its own thread touches it
  InputStudy::Answer studied_inputs_;             ///< the same
  std::optional<InputStudy::Answer> inputs_;      ///< the last study's
  Eigen::VectorXd input_shift_;                   ///< to the fit beside the inputs' errors; empty: not known yet
  double scale_then_ = 1.0;                       ///< the misfit's when the inputs' study was asked for
  Eigen::VectorXd studied_at_;                    ///< the filter's mean that the shift is from
  std::size_t last_inputs_ = 0;                   ///< frames that there were then
  bool corrected_ = false;                        ///< the loads' estimated errors are taken off
  bool restudying_ = false;                       ///< the last study is of a place that the runs have left
  Settling settling_;
  std::future<void> study_, input_work_;  ///< last: their threads use the members above
};

}  // namespace

std::unique_ptr<Scheme> make_unscented_scheme(const ModelSettings& settings, const TetMesh& mesh,
                                              const Relatives& relatives) {
  return std::make_unique<UnscentedScheme>(settings, mesh, relatives);
}

}  // namespace tissue_stiffness
