#include "fit/recording_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/nested_parameters.hpp"
#include "forward/basis_seed_vectors.hpp"
#include "forward/extra_force.hpp"
#include "forward/hyper_reduced_model.hpp"
#include "forward/linearised_model.hpp"
#include "forward/study_model.hpp"
#include "observation/frame_misfit.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kSteps = 6;             // a frame, and half of each: their period error would be taken for an effect
constexpr int kMostRuns = 8;          // moves of a fit from one full run to the next
constexpr int kMostCuts = 3;          // cuts of a move that makes it worse
constexpr double kSettled = 0.2;      // posterior standard deviations: shorter moves need no further run
constexpr double kWorthwhile = 2e-3;  // relative fall of the cost that quick runs must promise before another full one
constexpr double kGain = 1e-4;        // relative fall of the cost that a full run must bring
constexpr double kNarrower = 4.0;     // posterior standard deviations: span of the next fit's sigma points
constexpr double kProbe = 0.02;       // prior standard deviations: how far a parameter is moved for its sensitivity
constexpr int kBorrowed = 48;         // displacements of another fit's runs that train a model
constexpr int kSeen = 24;             // likewise, of the other model at first order

}  // namespace

std::vector<Frame> Recording::training() const {
  std::vector<Frame> kept;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!held_out(k)) kept.push_back(frames[k]);
  }
  return kept;
}

RecordingFit::RecordingFit(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                           const BasisOptions& basis)
    : RecordingFit(settings, mesh, resolve_regions(settings, mesh), recording, basis) {}

RecordingFit::RecordingFit(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions,
                           const Recording& recording, const BasisOptions& basis)
    : recording_(recording),
      training_(recording.training()),
      model_(settings, mesh, std::move(regions)),
      operators_(make_observation_operators(model_)),
      growths_(basis.growths) {
  prepare(&basis, nullptr);
}

RecordingFit::RecordingFit(const ModelSettings& settings, const RecordingFit& relative, const BasisOptions& basis)
    : RecordingFit(settings, relative, &basis) {}

RecordingFit::RecordingFit(const ModelSettings& settings, const RecordingFit& relative, const BasisOptions* basis)
    : recording_(relative.recording_),
      training_(relative.training_),
      model_(settings, relative.model_),
      operators_(make_observation_operators(model_)),
      growths_(relative.growths_) {
  prepare(basis, relative.forward_.get());
}

// Without a basis the forward model is still to come.
void RecordingFit::prepare(const BasisOptions* basis, const ForwardModel* relative) {
  recording_.checkpoint();  // what follows may take longer than a frame
  model_.loads().drive(recording_.first_stamp, recording_.loads);
  if (basis == nullptr) return;
  BasisOptions whole = *basis;
  whole.growths = growths_;
  whole.steps_per_frame = kSteps;
  whole.extrapolated = true;
  forward_ = make_forward_model(model_, whole, relative);
  const std::vector<int> nodes = observed_nodes(operators_, recording_.frames);
  forward_->restrict_output_to(nodes);
  if (studied_in_full(model_) || basis->nonlinear != BasisOptions::Nonlinear::in_full) return;
  BasisOptions quick = *basis;
  quick.growths = growths_;
  const auto& parts = model_.parts();
  const bool steered = std::any_of(parts.begin(), parts.end(), [&](const Model::Part& part) {
    return adds_extra_force(part) && model_.estimated(part);
  });
  quick.nonlinear = steered ? BasisOptions::Nonlinear::first_order : BasisOptions::Nonlinear::left_out;
  std::shared_ptr<ForwardModel> cheap = make_forward_model(model_, quick, relative);
  cheap->restrict_output_to(nodes);
  quick_ = std::move(cheap);
}

bool RecordingFit::may_be_hyper_reduced() const {
  return model_.nonlinear() && why_not_hyper_reduced(model_).empty();
}

bool RecordingFit::may_be_linearised() const {
  return model_.nonlinear() && !studied_in_full(model_) && why_not_linearised(model_).empty() &&
         model_.relaxations(model_.prior_theta()).empty();
}

std::vector<double> RecordingFit::times(const Eigen::VectorXd& theta) const {
  std::vector<double> out;
  for (const Frame& frame : recording_.frames) out.push_back(frame.time - model_.sensors().delay(theta));
  return out;
}

std::shared_ptr<const RecordingFit> RecordingFit::linearised(const ModelSettings& settings,
                                                             const Eigen::VectorXd& w) const {
  FullModel::Options full;
  full.steps_per_frame = 1;
  const Eigen::VectorXd own = model_.parameters().theta(w);
  const double start = problem(*forward_, training_).start.time, step = model_.settings().time.step;
  std::vector<double> instants;
  double before = start;
  for (const double time : times(own)) {
    const int steps = step > 0.0 ? static_cast<int>(std::ceil((time - before) / step * (1.0 - 1e-9))) : kSteps;
    for (int i = 1; i <= steps && time > before; ++i) instants.push_back(before + (time - before) * i / steps);
    before = std::max(before, time);
  }
  std::vector<DynamicState> run = FullModel(model_, full).states(own, start, instants, recording_.checkpoint);
  const std::shared_ptr<RecordingFit> out(new RecordingFit(settings, *this, static_cast<const BasisOptions*>(nullptr)));
  const ParameterSpace& parameters = out->model_.parameters();
  const Eigen::VectorXd at = NestedParameters(*out, *this).extend(w), theta = parameters.theta(at);
  LinearisedModel::Options options;
  options.stride = std::max<std::size_t>(1, instants.size() / recording_.frames.size());
  options.checkpoint = recording_.checkpoint;
  const Eigen::VectorXd moves = parameters.theta(at + kProbe * parameters.prior_std()) - theta;
  auto linearised = std::make_shared<LinearisedModel>(out->model_, theta, std::move(run), moves, options);
  linearised->restrict_output_to(observed_nodes(out->operators_, recording_.frames));
  out->forward_ = std::move(linearised);
  return out;
}

BasisOptions RecordingFit::keeping_root() {
  BasisOptions basis;
  basis.keep_root = true;
  return basis;
}

BasisOptions RecordingFit::chosen_at(const BatchFit& fit, BasisOptions basis) {
  basis.around = fit.w;
  basis.reach = fit.covariance.diagonal().cwiseSqrt();
  return basis;
}

void RecordingFit::borrow(const RecordingFit& base, const Eigen::VectorXd& w, const RecordingFit* seen,
                          const Eigen::VectorXd& seen_w) {
  if (!base.surrogate_ || !quick_) return;
  if (base.motions_.thetas.empty()) {
    surrogate_ = std::make_unique<CorrectedSurrogate>(*forward_, *quick_);
    surrogate_->move_as(*base.surrogate_);
    return;
  }
  const double start = problem(*forward_, training_).start.time;
  Eigen::VectorXd theta = model_.parameters().theta(w);
  if (may_be_hyper_reduced()) {
    motions_ = base.motions_.thinned(kBorrowed);
    if (seen != nullptr) {
      const auto run = seen->forward_->start(seen->model_.parameters().theta(seen_w), start);
      const std::vector<double> all = times(theta);
      for (std::size_t k = 0; k < kSeen; ++k) {
        run->advance(all[(2 * k + 1) * all.size() / (2 * kSeen)]);
        motions_.add({run->displacement(), {theta}});
      }
    }
    motions_.thetas.assign(motions_.thetas.size(), theta);
    quick_ = make_hyper_reduced(seen == nullptr ? base.quick_.get() : nullptr);
  }
  for (std::size_t i = 0; i < model_.parts().size(); ++i) {
    const auto known = [&](const Model::Part& part) { return part.label == model_.parts()[i].label; };
    const auto& parts = base.model_.parts();
    if (std::none_of(parts.begin(), parts.end(), known)) theta = theta_without_part(model_, i, theta);
  }
  surrogate_ = std::make_unique<CorrectedSurrogate>(*forward_, *quick_);
  surrogate_->anchor_as(*base.surrogate_, theta, start, recording_.checkpoint);
}

// Steps have one length, so that a run that leaves out held-out frames has the errors of one that does not.
std::shared_ptr<const ForwardModel> RecordingFit::make_hyper_reduced(const ForwardModel* relative) const {
  HyperOptions options;
  const double stated = model_.settings().time.step, span = recording_.frames.back().time - recording_.first_stamp;
  options.full.step = stated > 0.0 ? stated : span / static_cast<double>(2 * kSteps * recording_.frames.size());
  const auto* known = dynamic_cast<const HyperReducedModel*>(relative);
  auto reduced = known != nullptr ? std::make_shared<HyperReducedModel>(model_, *known)
                                  : std::make_shared<HyperReducedModel>(model_, motions_, options);
  reduced->restrict_output_to(observed_nodes(operators_, recording_.frames));
  return reduced;
}

FitProblem RecordingFit::problem(const ForwardModel& forward, const std::vector<Frame>& frames) const {
  const RunStart start{recording_.first_stamp + model_.settings().time.start};
  return {model_, forward, operators_, frames, start, recording_.checkpoint};
}

RecordingRows RecordingFit::rows(const Eigen::VectorXd& w) const {
  std::vector<Prediction> predictions;
  run_freely(problem(quick(), recording_.frames), w,
             [&](const Frame& frame, const Eigen::VectorXd& theta, const Eigen::Ref<const Eigen::VectorXd>& u) {
               predictions.push_back(predict_frame(model_, operators_, frame, theta, u));
             });
  return recording_rows(predictions);
}

Eigen::VectorXd RecordingFit::predicted(const Eigen::VectorXd& w) const {
  std::vector<double> out;
  run_freely(problem(quick(), recording_.frames), w,
             [&](const Frame& frame, const Eigen::VectorXd& theta, const Eigen::Ref<const Eigen::VectorXd>& u) {
               const Prediction p = predict_frame(model_, operators_, frame, theta, u);
               for (Eigen::Index i = 0; i < p.predicted.size(); ++i) {
                 const double row = p.predicted[i] / p.sigma[i];
                 out.push_back(std::isfinite(row) ? row : 0.0);
               }
             });
  return Eigen::Map<const Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

std::vector<Misfit> RecordingFit::show(const Eigen::VectorXd& w, const FreeFrameVisitor& visit) {
  forward_->restrict_output_to({});
  const FitProblem all = problem(*forward_, recording_.frames);
  return free_run({model_, *forward_, operators_, all.frames, all.start}, model_.parameters().theta(w),
                  [&](const FreeFrame& frame) {
                    recording_.checkpoint();
                    visit(frame);
                  });
}

Eigen::MatrixXd RecordingFit::rows_along(const Eigen::VectorXd& w, const Eigen::MatrixXd& shapes,
                                         const RecordingRows& rows) const {
  const FitProblem all = problem(quick(), recording_.frames);
  const Eigen::VectorXd theta = model_.parameters().theta(w);
  const auto run = quick().begin(theta, all.start);
  Eigen::MatrixXd out(rows.error.size(), shapes.cols());
  for (std::size_t k = 0; k < all.frames.size(); ++k) {
    recording_.checkpoint();
    run->advance(all.frames[k].time);
    const Eigen::VectorXd u = run->output();
    const auto [from, size] = rows.frames[static_cast<Eigen::Index>(k)];
    out.middleRows(from, size) = predict_along(model_, operators_, all.frames[k], theta, u, shapes);
  }
  for (Eigen::Index r = 0; r < out.rows(); ++r) {
    if (rows.used[r] > 0.0 && out.row(r).allFinite()) {
      out.row(r) *= rows.used[r] / rows.sigma[r];
    } else {
      out.row(r).setZero();
    }
  }
  return out;
}

std::shared_ptr<const ReducedModel> RecordingFit::reduced() const {
  if (auto linear = std::dynamic_pointer_cast<const ReducedModel>(forward_)) return linear;
  return std::make_shared<ReducedModel>(model_, BasisOptions().linear_form());
}

void RecordingFit::take_basis(std::shared_ptr<ReducedModel> larger, int growths) {
  forward_ = std::move(larger);
  growths_ += growths;
}

double RecordingFit::cost_in_full(const Eigen::VectorXd& w) const {
  try {
    return free_fit(problem(*forward_, training_), w).cost;
  } catch (const NumericalError&) {
    return std::numeric_limits<double>::infinity();
  }
}

BatchFit RecordingFit::fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double rival) {
  return quick_ ? fit_from_run_to_run(start, spread, rival) : quick_fit(start, spread, 1.0, rival);
}

const std::vector<Frame>& RecordingFit::first_of_training(double share, std::vector<Frame>& room) const {
  if (share >= 1.0) return training_;
  const auto count = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(training_.size())));
  room.assign(training_.begin(), training_.begin() + count);
  return room;
}

BatchFit RecordingFit::quick_fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double share,
                                 double rival) const {
  std::vector<Frame> room;
  const std::vector<Frame>& frames = first_of_training(share, room);
  return fit_batch(problem(quick(), frames), start, spread, rival);
}

RecordingFit::Run RecordingFit::run_in_full(const Eigen::VectorXd& w) {
  const double start = problem(*forward_, training_).start.time;
  const Eigen::VectorXd theta = model_.parameters().theta(w);
  std::vector<double> times;
  for (const Frame& frame : recording_.frames) times.push_back(frame.time);
  Run out{quick_, nullptr};
  if (!may_be_hyper_reduced()) {
    out.corrected = std::make_unique<CorrectedSurrogate>(*forward_, *out.cheap);
    out.corrected->anchor(theta, start, times, recording_.checkpoint);
    return out;
  }
  const Eigen::MatrixXd accurate = run_outputs(*forward_, theta, start, times, recording_.checkpoint);
  motions_.add({accurate, std::vector<Eigen::VectorXd>(times.size(), theta)});
  out.cheap = make_hyper_reduced(nullptr);
  out.corrected = std::make_unique<CorrectedSurrogate>(*forward_, *out.cheap);
  out.corrected->anchor_to(accurate, theta, start, times, recording_.checkpoint);
  return out;
}

// Every full run tells by how much quick runs are off there. A fit with that correction tells where the next full run has
// to be. Where the model leaves more than the noise, its parameters are known no better than that.
BatchFit RecordingFit::fit_from_run_to_run(Eigen::VectorXd at, Eigen::VectorXd spread, double rival) {
  Run run = run_in_full(at);
  const FreeFit first = free_fit(problem(*run.corrected, training_), at);
  double cost = first.cost;
  BatchFit fit;
  for (int k = 0; k < kMostRuns; ++k) {
    fit = fit_batch(problem(*run.corrected, training_), at, spread);
    const double misfit = std::sqrt(std::max(1.0, fit.cost / std::max(1.0, first.rows)));
    const Eigen::VectorXd std = misfit * fit.covariance.diagonal().cwiseSqrt();
    Eigen::VectorXd move = fit.w - at;
    const bool settled = (move.array().abs() < kSettled * std.array()).all();
    if (settled || cost - fit.cost < kWorthwhile * cost || fit.cost > rival) break;
    double gain = 0.0;
    for (int cut = 0; cut < kMostCuts && !(gain > 0.0); ++cut, move *= 0.3) {
      Run there;
      double now = std::numeric_limits<double>::infinity();
      try {
        there = run_in_full(at + move);
        now = free_fit(problem(*there.corrected, training_), at + move).cost;
      } catch (const NumericalError&) {  // such a move is cut, too
      }
      gain = cost - now;
      if (!(gain > 0.0)) continue;
      if (there.cheap == run.cheap) {
        there.corrected->follow(
            *run.corrected,
            (model_.parameters().theta(at + model_.parameters().prior_std()) - model_.parameters().theta(at)).cwiseAbs());
      }
      at += move;
      cost = now;
      run = std::move(there);
    }
    if (!(gain > kGain * cost)) break;
    spread = spread.cwiseMin(kNarrower * std);
  }
  fit.w = at;
  quick_ = std::move(run.cheap);
  surrogate_ = std::move(run.corrected);
  return fit;
}

Eigen::Index RecordingFit::index(const std::string& parameter) const {
  const auto& free = model_.parameters().free();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].name == parameter) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

FittedModel fit_recording(std::unique_ptr<RecordingFit> recording_fit, const Eigen::VectorXd& start, double spread) {
  FittedModel out;
  out.fit = recording_fit->fit(start, spread * recording_fit->model().parameters().prior_std());
  out.rows = recording_fit->rows(out.fit.w);
  out.recording_fit = std::move(recording_fit);
  return out;
}

}  // namespace tissue_stiffness
