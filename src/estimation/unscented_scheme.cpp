// The default scheme: free-running sigma points, iterated. `step` reads: predict, observe, update, revisit.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include "tissue_stiffness/estimation/basis_error.hpp"
#include "tissue_stiffness/estimation/choose_correction.hpp"
#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/coordinate_scan.hpp"
#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/estimation/initial_velocity.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/estimation/posterior.hpp"
#include "tissue_stiffness/estimation/scheme.hpp"
#include "tissue_stiffness/estimation/stopwatch.hpp"
#include "tissue_stiffness/estimation/validity.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFar = 1.0;                   // spreads between anchor and estimate that ask for a new anchor
constexpr double kWide = 6.0;                  // posterior standard deviations that the sigma points may span
constexpr double kNewSpread = 2.0;             // posterior standard deviations that they span after a move
constexpr double kFloor = 1e-3;                // of the prior's standard deviation: the smallest span
constexpr double kBent = 0.2;                  // of the misfit: nonlinearity over the span that asks for a smaller one
constexpr double kLongestMove = 3.0;           // spreads that the anchor may move at once
constexpr int kMostVisits = 6;                 // moves of the anchor a frame
constexpr std::size_t kEarly = 16;             // frames up to which the anchor may move at every frame
constexpr double kRevisitGrowth = 1.1;         // of the recording between moves of the anchor later
constexpr double kScanMisfit = 4.0;            // mean square error over sigma that asks for a scan of the parameters
constexpr int kScanPoints = 25;                // on either side of the prior's mean
constexpr double kUnexplained = 0.1;           // of the motion's mean square: more, and a free run's fit is badly biased
constexpr std::size_t kCorrectFrom = 16;       // frames before which a misfit is not taken for missing physics
constexpr int kVelocityFrames = 4;             // frames that the initial velocity is read from
constexpr std::size_t kWindow = 4000;          // frames kept for replay; later ones only add information
constexpr double kConverged = 0.05;            // relative standard deviation
constexpr double kShiftDoubt = 0.5;            // of the mesh's effect, once it is corrected for
constexpr std::size_t kFirstBasisLook = 4;     // frames
constexpr double kBasisShare = 0.1;            // of the noise: what the reduced basis may leave out
constexpr int kMostGrowths = 4;                // of the basis at once, by half each
constexpr std::size_t kRehearsed = 30;         // instants before the first frame
constexpr double kRehearsalStep = 1.0 / 30.0;  // [s]
constexpr double kGrowthHelps = 0.9;           // of the error: what a growth leaves, if it is worth another
constexpr double kInvalidSigmas = 10.0;        // rms error over noise at which the model says nothing about the body

class UnscentedScheme : public Scheme {
 public:
  UnscentedScheme(const ModelSettings& settings, const TetMesh& mesh)
      : Scheme(settings, mesh),
        ensemble_(*model_, *forward_, operators_),
        filter_(model_->prior_mean(), model_->prior_std()),
        unstudied_(why_no_mesh_study()) {}

  std::vector<std::string> description() const override {
    return {forward_->description(),
            "mesh error: " + (unstudied_.empty() ? "from a mesh refined eightfold" : "not assessed, " + unstudied_)};
  }

  std::vector<Misfit> free_run(const FreeFrameVisitor& visit) const override {
    return frames_.empty() ? std::vector<Misfit>{} : compare_free_run(frames_, model_->theta(filter_.mean()), visit);
  }
  std::optional<double> basis_error() const override { return basis_error_; }
  Eigen::MatrixXd parameter_covariance() const override { return filter_.covariance(); }
  void work_in_background() override { background_ = true; }

 protected:
  StepResult process(const Frame& frame) override {
    if (model_->settings().initial.kind == InitialSettings::Kind::from_frames && !ensemble_.started()) {
      return wait_for_velocity(frame);
    }
    return assimilate(frame);
  }

  void forget() override {
    frames_.clear();
    waiting_.clear();
    ensemble_.clear();
    filter_ = AnchoredFilter(model_->prior_mean(), model_->prior_std());
    corrected_ = nullptr;
    if (study_.valid()) study_.wait();
    study_ = {};
    shift_.resize(0);
    last_study_ = last_basis_look_ = 0;
    basis_error_.reset();
    complete_ = true;
    last_revisit_ = last_correction_ = 0;
    last_scan_ = 1;
    validity_.reset();
  }

 private:
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
    filter_ = AnchoredFilter(model_->prior_mean(), model_->prior_std());
    StepResult result;
    for (const Frame& kept : waiting_) result = assimilate(kept);
    waiting_.clear();
    return result;
  }

  StepResult assimilate(const Frame& frame) {
    StepResult result;
    Stopwatch watch(result.seconds);
    focus_on(frame);
    start_if_needed();
    ensemble_.advance(frame.time);
    watch.lap("predict");
    Ensemble::Predicted predicted = ensemble_.predict(frame);
    watch.lap("observe");
    const AnchoredFilter::Innovation innovation = corrected_ ? corrected_->absorb(frame, filter_) : absorb(predicted);
    if (complete_) frames_.push_back(frame);
    watch.lap("update");
    if (frames_.size() > kWindow) {
      complete_ = false;
      frames_.clear();
    }
    if (complete_ && revisit()) predicted = ensemble_.predict(frame);
    watch.lap("revisit");
    if (complete_ && study_basis()) predicted = ensemble_.predict(frame);
    watch.lap("basis");
    study_mesh();
    watch.lap("mesh error");
    publish(frame, predicted, innovation, result);
    watch.lap("report");
    return result;
  }

  void start_if_needed() {
    if (ensemble_.started()) return;
    rehearse();
    restart();
  }

  // Lets the basis grow before the first frame as far as loads tell that are known by then, so that no later one waits.
  void rehearse() {
    std::vector<Frame> instants(kRehearsed);
    for (std::size_t k = 0; k < instants.size(); ++k) {
      instants[k].time = start() + kRehearsalStep * static_cast<double>(k + 1);
    }
    grow_basis(instants);
  }

  void restart() {
    ensemble_.restart(filter_.sigma_points(), start());
    if (corrected_) corrected_->restart(filter_.sigma_points(), start());
  }

  AnchoredFilter::Innovation absorb(const Frame& frame) {
    if (corrected_) return corrected_->absorb(frame, filter_);
    ensemble_.advance(frame.time);
    return absorb(ensemble_.predict(frame));
  }

  AnchoredFilter::Innovation absorb(const Ensemble::Predicted& predicted) {
    Prediction now = predicted.central;
    now.predicted = filter_.predict(predicted.rows, filter_.mean());
    return filter_.update(now.measured, predicted.rows, now.sigma.cwiseAbs2(), row_weights(now));
  }

  bool bent() const { return filter_.nonlinearity() > kBent * filter_.misfit_scale(); }

  // Moves the sigma points to where the estimate went and runs the recording again, until nothing moves. True if moved.
  bool revisit() {
    const std::size_t count = frames_.size();
    if (count > kEarly && static_cast<double>(count) < kRevisitGrowth * static_cast<double>(last_revisit_)) return false;
    bool moved = scan();
    moved = settle() || moved;
    if (correct_state()) {
      settle();
      moved = true;
    }
    if (moved) last_revisit_ = count;
    return moved;
  }

  bool settle() {
    bool moved = false;
    const Eigen::VectorXd floor = kFloor * model_->prior_std();
    for (int visit = 0; visit < kMostVisits && (filter_.stale(kFar, kWide, floor) || bent()); ++visit) {
      move_anchor(floor);
      moved = true;
    }
    return moved;
  }

  void move_anchor(const Eigen::VectorXd& floor) {
    const AnchoredFilter before = filter_;
    const Eigen::VectorXd limit = kLongestMove * before.spread();
    Eigen::VectorXd move = (before.mean() - before.anchor()).cwiseMax(-limit).cwiseMin(limit);
    const Eigen::VectorXd std = before.covariance().diagonal().cwiseSqrt();
    Eigen::VectorXd spread = (kNewSpread * std).cwiseMin(before.spread());
    if (bent()) {
      const double excess = before.nonlinearity() / (kBent * before.misfit_scale());
      spread = spread.cwiseMin(0.8 * std::pow(excess, -0.25) * before.spread());
    }
    spread = spread.cwiseMax(floor);
    for (int cut = 0; cut < 3; ++cut, move *= 0.25) {
      replay(before.anchor() + move, spread);
      if (filter_.cost() <= before.cost() * (1.0 + 1e-3) + 1.0) return;
    }
    replay(before.anchor(), spread);
  }

  // When the misfit is large, looks for a better minimum whenever the recording has doubled; linear models only, whose runs
  // cost next to nothing.
  bool scan() {
    if (model_->nonlinear() || corrected_ || frames_.size() < 2 * last_scan_ || filter_.misfit_scale() < kScanMisfit) {
      return false;
    }
    last_scan_ = frames_.size();
    return go_to(scan_coordinates([this](const Eigen::VectorXd& w) { return free_fit(problem(), w).cost; },
                                  filter_.anchor(), model_->prior_mean(), model_->prior_std(), kScanPoints));
  }

  bool go_to(const ScanResult& found) {
    if (!found.moved) return false;
    replay(found.best, (found.step.array() > 0.0).select(found.step.cwiseMin(filter_.spread()), filter_.spread()));
    return true;
  }

  // A free run that no parameters bring near the data lacks physics, and its best fit is biased. The parameters are then
  // read from runs corrected towards each frame, by as much as makes the data most likely. Decided anew whenever the
  // recording has doubled. True if the runs changed.
  bool correct_state() {
    if (model_->nonlinear() || !complete_ || frames_.size() < std::max(kCorrectFrom, 2 * last_correction_)) return false;
    last_correction_ = frames_.size();
    const Eigen::VectorXd w = filter_.mean();
    const FreeFit free = free_fit(problem(), w);
    const bool lacking = free.cost > kScanMisfit * free.rows && free.cost > kUnexplained * free.motion;
    const auto correction = lacking ? choose_correction(problem(), w) : std::nullopt;
    if (!correction) {
      if (corrected_ == nullptr) return false;
      corrected_ = nullptr;
      replay(w, filter_.spread());
      return true;
    }
    corrected_ = std::make_unique<CorrectedRuns>(*model_, *forward_, operators_, correction->force);
    replay(correction->w, (correction->step.array() > 0.0).select(correction->step, filter_.spread()));
    return true;
  }

  FitProblem problem() const { return {*model_, *forward_, operators_, frames_, start()}; }

  void replay(const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread) {
    filter_.move_anchor(anchor, spread);
    restart();
    for (const Frame& frame : frames_) absorb(frame);
    if (corrected_) ensemble_.advance(frames_.back().time);
  }

  void publish(const Frame& frame, const Ensemble::Predicted& predicted, const AnchoredFilter::Innovation& innovation,
               StepResult& result) {
    const Eigen::VectorXd w = filter_.mean();
    prediction_ = predicted.central;
    prediction_.predicted = filter_.predict(predicted.rows, w);
    const Eigen::Index points = predicted.rows.cols();
    recover_ = [this, weights = filter_.predict(Eigen::MatrixXd::Identity(points, points), w)] {
      return ensemble_.combined(weights);
    };
    if (model_->nonlinear()) displacement();  // before a step that fails half-way
    result.used = true;
    result.misfit = compare(frame.time, prediction_, at_rest(frame).predicted, model_->mesh().node_count());
    result.misfit.nis = innovation.nis;
    result.misfit.dof = innovation.dof;
    const Eigen::VectorXd shift = shift_.size() > 0 ? shift_ : Eigen::VectorXd::Zero(w.size());
    const double doubt = kShiftDoubt * kShiftDoubt;
    estimate_ = summarise(model_->free_parameters(), w - shift, filter_.covariance() + doubt * shift * shift.transpose());
    estimate_.time = frame.time;
    validity_.add(result.misfit);
    estimate_.state = state(result.misfit);
    result.estimate = estimate_;
  }

  EstimateState state(const Misfit& misfit) const {
    if (misfit.count == 0) return EstimateState::no_data;
    if (misfit.rms_sigma > kInvalidSigmas) return EstimateState::model_invalid;
    for (std::size_t i = 0; i < estimate_.parameters.size(); ++i) {
      const ParameterEstimate& p = estimate_.parameters[i];
      const bool positive = model_->free_parameters()[i].prior.kind == Quantity::Kind::log_normal;
      const double scale = positive ? std::abs(p.mean) : model_->free_parameters()[i].prior.spread;
      if (p.std > kConverged * scale) return EstimateState::converging;
    }
    return validity_.invalid() ? EstimateState::model_invalid : EstimateState::converged;
  }

  std::string why_no_mesh_study() const {
    if (!model_->settings().mesh.discretisation_error) return "the model file asks not to";
    if (model_->nonlinear()) return "the model is not linear";
    return MeshError::why_not(model_->mesh());
  }

  // What the reduced basis leaves out, asked anew whenever the recording has doubled; the basis grows until it is a small
  // part of the noise. True if the runs changed.
  bool study_basis() {
    if (frames_.size() < std::max(kFirstBasisLook, 2 * last_basis_look_)) return false;
    last_basis_look_ = frames_.size();
    const bool grown = grow_basis(frames_);
    if (grown) replay(filter_.anchor(), filter_.spread());
    return grown;
  }

  bool grow_basis(const std::vector<Frame>& frames) {
    auto* reduced = dynamic_cast<ReducedModel*>(forward_.get());
    if (reduced == nullptr) return false;
    const FitProblem run{*model_, *forward_, operators_, frames, start()};
    bool grown = false;
    for (int k = 0;; ++k) {
      const BasisError error = tissue_stiffness::basis_error(*reduced, run, filter_.mean());
      const bool helps = k == 0 || error.rms < kGrowthHelps * *basis_error_;
      basis_error_ = error.rms;
      if (basis_exhausted_ || error.sigmas <= kBasisShare) return grown;
      basis_exhausted_ = k == kMostGrowths || !helps || !reduced->grow();
      if (basis_exhausted_) return grown;
      grown = true;
    }
  }

  // What the mesh does to the estimate, asked anew whenever the recording has doubled; in the background when a node runs.
  void study_mesh() {
    if (study_.valid() && (!background_ || study_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)) {
      try {
        shift_ = study_.get();
      } catch (const std::exception& error) {
        unstudied_ = error.what();
      }
    }
    if (study_.valid() || !unstudied_.empty() || frames_.size() < std::max(kEarly, 2 * last_study_)) return;
    last_study_ = frames_.size();
    MeshError::Question question{
        frames_, filter_.mean(), filter_.spread(), model_->prior_std(), start(), model_->first_stamp(), {}};
    for (const auto& [topic, course] : model_->courses()) question.courses.emplace(topic, *course);
    study_ = std::async(std::launch::async, [this, question = std::move(question)] {
      if (mesh_error_ == nullptr) mesh_error_ = std::make_unique<MeshError>(model_->settings(), model_->mesh());
      return mesh_error_->shift(question);
    });
    if (!background_) study_mesh();
  }

  Ensemble ensemble_;
  AnchoredFilter filter_;
  Validity validity_;
  std::unique_ptr<CorrectedRuns> corrected_;  ///< while the model lacks physics; the ensemble runs free beside it
  std::vector<Frame> frames_, waiting_;
  bool complete_ = true;  ///< every frame since the start is in frames_
  std::size_t last_revisit_ = 0, last_scan_ = 1, last_correction_ = 0;

  std::string unstudied_;                  ///< why the mesh's error is not assessed; empty: it is
  std::unique_ptr<MeshError> mesh_error_;  ///< the study's own; only its thread touches it
  Eigen::VectorXd shift_;                  ///< estimate less truth because of the mesh; empty: not known yet
  std::size_t last_study_ = 0;
  std::optional<double> basis_error_;  ///< [m]
  std::size_t last_basis_look_ = 0;
  bool basis_exhausted_ = false;  ///< more vectors do not help
  bool background_ = false;
  std::future<Eigen::VectorXd> study_;  ///< last: its thread uses the members above
};

}  // namespace

std::unique_ptr<Scheme> make_unscented_scheme(const ModelSettings& settings, const TetMesh& mesh) {
  return std::make_unique<UnscentedScheme>(settings, mesh);
}

}  // namespace tissue_stiffness
