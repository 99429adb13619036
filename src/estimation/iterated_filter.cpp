#include "estimation/iterated_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/basis_error.hpp"
#include "estimation/hyper_reduction.hpp"
#include "estimation/systematic_error.hpp"
#include "fit/coordinate_scan.hpp"
#include "forward/hyper_reduced_model.hpp"
#include "forward/reduced_model.hpp"
#include "forward/study_model.hpp"
#include "meshing/surface.hpp"
#include "observation/frame_misfit.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFar = 1.0;                    // spreads between anchor and estimate that ask for a new anchor
constexpr double kWide = 6.0;                   // posterior standard deviations that the sigma points may span
constexpr double kNewSpread = 2.0;              // posterior standard deviations that they span after a move
constexpr double kFloor = 1e-3;                 // of the prior's standard deviation: the smallest span
constexpr double kBent = 0.2;                   // of the misfit: nonlinearity over the span that asks for a smaller one
constexpr double kLongestMove = 3.0;            // spreads that the anchor may move at once
constexpr int kMostVisits = 6;                  // moves of the anchor in one relinearization
constexpr std::size_t kEarly = 16;              // frames up to which the anchor may move at every frame
constexpr double kRelinearizationGrowth = 1.1;  // growth of the recording between later moves of the anchor
constexpr double kScanMisfit = 4.0;             // mean square error over sigma that asks for a scan of the parameters
constexpr int kScanPoints = 25;                 // points on either side of the prior's mean
constexpr std::size_t kFirstBasisCheck = 4;     // frames before the first check of the basis
constexpr double kChangedSpread = 0.05;         // prior standard deviations, of the sigma points after a change
constexpr int kWatchedFrames = 4;               // frames between looks at the residual in full, which cost as many frames
constexpr double kBeyond = 1.5;                 // times the energy of the training: a larger motion has to be checked
constexpr double kSurprise = 2.0;               // times the residual of the last check: it has to be made again

}  // namespace

IteratedFilter::IteratedFilter(const Model& model, const Operators& operators, std::shared_ptr<ForwardModel> forward,
                               PosteriorLinearizationFilter prior, RunStart start)
    : model_(model),
      operators_(operators),
      forward_(std::move(forward)),
      start_(std::move(start)),
      filter_(std::move(prior)) {}

std::unique_ptr<IteratedFilter> IteratedFilter::clone_unstarted() const {
  auto out = std::make_unique<IteratedFilter>(model_, operators_, forward_, filter_, start_);
  out->discrepancy_ = discrepancy_;
  out->notes_ = notes_;
  return out;
}

void IteratedFilter::expect(const Estimate& near) {
  Eigen::VectorXd anchor = filter_.anchor(), spread = filter_.spread();
  for (std::size_t i = 0; i < model_.parameters().free().size(); ++i) {
    const FreeParameter& free = model_.parameters().free()[i];
    const auto known = std::find_if(near.parameters.begin(), near.parameters.end(),
                                    [&free](const ParameterEstimate& p) { return p.name == free.name; });
    if (known == near.parameters.end()) continue;
    const auto k = static_cast<Eigen::Index>(i);
    anchor[k] = free.to_coordinate(known->mean);
    const double wide = free.to_coordinate(known->mean + kNewSpread * known->std) - anchor[k];
    spread[k] = std::clamp(wide, kFloor * spread[k], spread[k]);
  }
  filter_.move_anchor(anchor, spread);
}

void IteratedFilter::begin() {
  ensemble_ = std::make_unique<Ensemble>(model_, *forward_, operators_);
  ensemble_->restart(filter_.sigma_points(), start_);
  residual_ = nullptr;
}

void IteratedFilter::advance(double time) {
  ensemble_->advance(time);
  const auto reduced = std::dynamic_pointer_cast<HyperReducedModel>(forward_);
  if (!reduced) return;
  const auto& central = dynamic_cast<const HyperReducedTrajectory&>(ensemble_->trajectory(0));
  const HyperBasis& basis = reduced->basis();
  notes_.surprised = notes_.surprised || basis.energy(central.coordinates()) > kBeyond * basis.trained;
  if (++unwatched_ < kWatchedFrames) return;
  unwatched_ = 0;
  watch_residual();
}

void IteratedFilter::watch_residual() {
  if (!residual_) residual_ = std::make_unique<FullResidual>(model_, theta(filter_.sigma_points().col(0)));
  const auto& central = dynamic_cast<const HyperReducedTrajectory&>(ensemble_->trajectory(0));
  notes_.surprised = notes_.surprised || residual_->of(central) > kSurprise * notes_.residual;
}

PosteriorLinearizationFilter::Innovation IteratedFilter::absorb(const Ensemble::Predicted& predicted) {
  Prediction now = predicted.central;
  now.predicted = filter_.predict(predicted.rows, filter_.mean());
  return filter_.update(now.measured, predicted.rows, now.sigma.cwiseAbs2(), row_weights(now));
}

PosteriorLinearizationFilter::Innovation IteratedFilter::absorb(const Frame& frame) {
  ensemble_->advance(frame.time);
  return absorb(ensemble_->predict(frame));
}

Eigen::VectorXd IteratedFilter::mean() const {
  return notes_.correction.size() > 0 ? Eigen::VectorXd(filter_.mean() - notes_.correction) : filter_.mean();
}

Eigen::MatrixXd IteratedFilter::covariance() const {
  Eigen::MatrixXd sum = filter_.robust_covariance();
  for (const Eigen::VectorXd& discrepancy : {discrepancy_, notes_.basis_shift}) {
    if (discrepancy.size() > 0) sum += discrepancy * discrepancy.transpose();
  }
  return notes_.correction.size() > 0 ? Eigen::MatrixXd(sum + left_by_hyper_reduction()) : sum;
}

// The motion that is left out may lie along the change that the parameters make, with all rows alike. Its mean square is d:
// C = d N C_noise, and no more than the prior.
Eigen::MatrixXd IteratedFilter::left_by_hyper_reduction() const {
  const double d = std::pow(notes_.basis_error.value_or(0.0) / least_noise(model_), 2);
  return within_prior(d * filter_.rows() * filter_.robust_covariance(), model_.parameters().prior_std());
}

bool IteratedFilter::bent() const {
  return filter_.nonlinearity() > kBent * filter_.misfit_scale();
}

bool IteratedFilter::stale() const {
  return filter_.stale(kFar, kWide, kFloor * model_.parameters().prior_std()) || bent();
}

bool IteratedFilter::settle_is_due(std::size_t count) const {
  return count <= kEarly || static_cast<double>(count) >= kRelinearizationGrowth * static_cast<double>(notes_.settled);
}

// Only models whose runs are quick are scanned.
bool IteratedFilter::scan_is_due(std::size_t count) const {
  return studied_in_full(model_) && count >= 2 * notes_.scanned && filter_.misfit_scale() >= kScanMisfit;
}

bool IteratedFilter::basis_is_due(std::size_t count) const {
  const bool reduced = !model_.nonlinear() || may_be_hyper_reduced(model_);
  if (!reduced || start_.motion || count < kFirstBasisCheck) return false;
  return notes_.surprised || count >= 2 * notes_.basis;
}

bool IteratedFilter::wants_relinearization(std::size_t count) const {
  const bool relinearization = settle_is_due(count) && (stale() || scan_is_due(count));
  return relinearization || basis_is_due(count);
}

void IteratedFilter::rerun(const std::vector<Frame>& frames, const Eigen::VectorXd& w) {
  const FitProblem run = problem(frames, [] {});
  replay(run, w, filter_.spread());
  settle(run);
}

bool IteratedFilter::relinearize(const std::vector<Frame>& frames, const Checkpoint& checkpoint) {
  try {
    return relinearize_runs(frames, checkpoint);
  } catch (const NumericalError&) {
    return false;
  }
}

bool IteratedFilter::relinearize_runs(const std::vector<Frame>& frames, const Checkpoint& checkpoint) {
  const std::size_t count = frames.size();
  const FitProblem run = problem(frames, checkpoint);
  bool moved = false;
  if (settle_is_due(count)) {
    moved = scan(run);
    moved = settle(run) || moved;
    if (moved) notes_.settled = count;
  }
  if (grow_basis(run)) {
    replay(problem(frames, checkpoint), filter_.anchor(), filter_.spread());
    moved = true;
  }
  return moved;
}

std::unique_ptr<IteratedFilter> IteratedFilter::changed(const std::vector<Frame>& frames, const ChangeQuestion& question,
                                                        const Checkpoint& checkpoint, std::size_t& first) const {
  try {
    const auto change = find_change(problem(frames, checkpoint), question);
    if (!change) return nullptr;
    Eigen::MatrixXd prior = question.covariance;
    prior.diagonal() += drifted(model_, change->from.time - start_.time);
    auto out = std::make_unique<IteratedFilter>(model_, operators_, forward_,
                                                PosteriorLinearizationFilter(question.w, prior), change->from);
    const std::vector<Frame> later(frames.begin() + static_cast<std::ptrdiff_t>(change->first), frames.end());
    const Eigen::VectorXd spread = prior.diagonal().cwiseSqrt().cwiseMin(kChangedSpread * model_.parameters().prior_std());
    out->replay(out->problem(later, checkpoint), change->w, spread);
    out->discrepancy_ = change->discrepancy;
    out->relinearize(later, checkpoint);
    first = change->first;
    return out;
  } catch (const NumericalError&) {
    return nullptr;
  }
}

std::unique_ptr<IteratedFilter> IteratedFilter::rolled(const std::vector<Frame>& frames, std::size_t first,
                                                       const Checkpoint& checkpoint) const {
  // Runs in full would never catch up with a camera.
  if (model_.nonlinear()) return nullptr;
  const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(first);
  const std::vector<Frame> early(frames.begin(), middle), later(middle, frames.end());
  try {
    const std::unique_ptr<IteratedFilter> before = clone_unstarted();
    before->replay(problem(early, checkpoint), filter_.anchor(), filter_.spread());
    const Eigen::VectorXd theta = model_.parameters().theta(filter_.mean());
    const auto run = forward_->begin(theta, start_);
    const double time = early.back().time - model_.sensors().delay(theta);
    run->advance(time);
    PosteriorLinearizationFilter prior(before->filter_.mean(), before->filter_.robust_covariance());
    auto out = std::make_unique<IteratedFilter>(model_, operators_, forward_, std::move(prior),
                                                RunStart{time, forward_->resume(theta, *run)});
    out->discrepancy_ = discrepancy_;
    out->notes_ = notes_;
    out->notes_.settled = out->notes_.scanned = later.size();
    out->replay(out->problem(later, checkpoint), filter_.anchor(), filter_.spread());
    return out;
  } catch (const NumericalError&) {
    return nullptr;
  }
}

FitProblem IteratedFilter::problem(const std::vector<Frame>& frames, const Checkpoint& checkpoint) const {
  return {model_, *forward_, operators_, frames, start_, checkpoint};
}

bool IteratedFilter::settle(const FitProblem& problem) {
  int visit = 0;
  for (; visit < kMostVisits && stale(); ++visit) move_anchor(problem);
  return visit > 0;
}

void IteratedFilter::move_anchor(const FitProblem& problem) {
  const PosteriorLinearizationFilter before = filter_;
  const Eigen::VectorXd limit = kLongestMove * before.spread();
  Eigen::VectorXd move = (before.mean() - before.anchor()).cwiseMax(-limit).cwiseMin(limit);
  const Eigen::VectorXd std = before.covariance().diagonal().cwiseSqrt();
  Eigen::VectorXd spread = (kNewSpread * std).cwiseMin(before.spread());
  if (bent()) {
    const double excess = before.nonlinearity() / (kBent * before.misfit_scale());
    spread = spread.cwiseMin(0.8 * std::pow(excess, -0.25) * before.spread());
  }
  spread = spread.cwiseMax(kFloor * model_.parameters().prior_std());
  for (int cut = 0; cut < 3; ++cut, move *= 0.25) {
    replay(problem, before.anchor() + move, spread);
    if (filter_.cost() <= before.cost() * (1.0 + 1e-3) + 1.0) return;
  }
  replay(problem, before.anchor(), spread);
}

// Searches for a better minimum whenever the recording has doubled while the misfit is large.
bool IteratedFilter::scan(const FitProblem& problem) {
  if (!scan_is_due(problem.frames.size())) return false;
  notes_.scanned = problem.frames.size();
  const ScanResult found =
      scan_coordinates([&](const Eigen::VectorXd& w) { return free_fit(problem, w).cost; }, filter_.anchor(),
                       model_.parameters().prior_mean(), model_.parameters().prior_std(), kScanPoints);
  if (!found.moved) return false;
  const Eigen::VectorXd narrow = found.step.cwiseMin(filter_.spread());
  replay(problem, found.best, (found.step.array() > 0.0).select(narrow, filter_.spread()));
  return true;
}

// Checks what the reduced basis leaves out whenever the recording has doubled. The basis grows until that is a small part
// of the noise. Returns true if it grew.
bool IteratedFilter::grow_basis(const FitProblem& problem) {
  if (!basis_is_due(problem.frames.size())) return false;
  notes_.basis = problem.frames.size();
  if (model_.nonlinear()) return check_hyper_reduction(problem);
  const auto& reduced = dynamic_cast<const ReducedModel&>(*forward_);
  BasisGrowth growth =
      tissue_stiffness::grow_basis(reduced, notes_.basis_exhausted, problem, filter_.mean(), surface_nodes(model_.mesh()));
  notes_.basis_error = growth.error.rms;
  notes_.basis_exhausted = growth.exhausted;
  notes_.basis_shift = basis_shift(growth.larger ? *growth.larger : reduced, problem, filter_.mean(), filter_.spread(),
                                   model_.parameters().prior_std());
  if (!growth.larger) return false;
  forward_ = std::move(growth.larger);
  return true;
}

bool IteratedFilter::check_hyper_reduction(const FitProblem& problem) {
  HyperReduction reduced = hyper_reduce(
      problem, forward_,
      {filter_.mean(), filter_.sigma_points(), filter_.spread(), model_.parameters().prior_std(), notes_.accepted});
  notes_.basis_error = reduced.error;
  notes_.basis_shift = notes_.correction = std::move(reduced.shift);
  notes_.residual = reduced.residual;
  notes_.accepted = reduced.accepted;
  notes_.surprised = false;
  const bool changed = reduced.forward != forward_;
  forward_ = std::move(reduced.forward);
  return changed;
}

void IteratedFilter::replay(const FitProblem& problem, const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread) {
  filter_.move_anchor(anchor, spread);
  begin();
  for (const Frame& frame : problem.frames) {
    problem.checkpoint();
    absorb(frame);
  }
}

}  // namespace tissue_stiffness
