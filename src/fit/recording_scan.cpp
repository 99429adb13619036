// Where a fit of a recording may start: costs of free runs at many places.
#include <cmath>
#include <utility>

#include "fit/coordinate_scan.hpp"
#include "fit/recording_fit.hpp"
#include "fit/variable_projection.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kScanPoints = 12;
constexpr double kScanReach = 2.5;     // prior standard deviations to either side
constexpr int kMostSolves = 4;         // of a projection, whose robust weights follow the fit
constexpr double kGainOfSolve = 0.01;  // relative fall of the cost that is worth another one

// Returns the place after those coordinates, in which the run is linear, have been solved for.
RecordingFit::Place solved_for(const std::vector<Eigen::Index>& linear, const FitProblem& problem,
                               const RecordingFit::Place& from) {
  const auto cost = [&problem](const Eigen::VectorXd& w) { return free_fit(problem, w).cost; };
  RecordingFit::Place out = from;
  if (!std::isfinite(out.cost)) out.cost = cost(out.w);
  for (int k = 0; k < kMostSolves && !linear.empty(); ++k) {
    RecordingFit::Place next{variable_projection(problem, out.w, linear)};
    next.cost = cost(next.w);
    if (!(next.cost < out.cost)) break;
    std::swap(out, next);
    if (!(out.cost < (1.0 - kGainOfSolve) * next.cost)) break;
  }
  return out;
}

}  // namespace

Eigen::VectorXd RecordingFit::scan(const Eigen::VectorXd& start) const {
  return scan_coordinates(cost_of(1.0), start, model_.parameters().prior_mean(), model_.parameters().prior_std(),
                          kScanPoints)
      .best;
}

RecordingFit::Place RecordingFit::scan_near(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& coordinates,
                                            double share) const {
  const ScanResult nearest = scan_around(cost_of(share), start, model_.parameters().prior_std(), coordinates);
  return {nearest.best, nearest.lowest};
}

RecordingFit::Place RecordingFit::scan_prior(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& coordinates,
                                             const std::vector<Eigen::Index>& linear, double share) const {
  Eigen::VectorXd std = Eigen::VectorXd::Zero(start.size());
  for (const Eigen::Index i : coordinates) std[i] = model_.parameters().prior_std()[i];
  std::vector<Frame> room;
  const FitProblem first = problem(quick(), first_of_training(share, room));
  const auto cost = [&](const Eigen::VectorXd& w) { return solved_for(linear, first, {w}).cost; };
  const ScanResult far = scan_coordinates(cost, start, model_.parameters().prior_mean(), std, kScanPoints, kScanReach);
  const ScanResult refined = refine_coordinates(cost, far.best, far.lowest, kScanReach / kScanPoints * std);
  return solved_for(linear, first, {refined.best, linear.empty() ? refined.lowest : no_rival});
}

RecordingFit::Place RecordingFit::project(const Place& from, const std::vector<Eigen::Index>& linear, double share) const {
  if (linear.empty()) return from;
  std::vector<Frame> room;
  return solved_for(linear, problem(quick(), first_of_training(share, room)), from);
}

std::vector<double> RecordingFit::costs(const std::vector<Eigen::VectorXd>& places, const std::vector<Eigen::Index>& linear,
                                        double share) const {
  std::vector<Frame> room;
  const FitProblem first = problem(quick(), first_of_training(share, room));
  std::vector<double> out;
  out.reserve(places.size());
  for (const Eigen::VectorXd& w : places) out.push_back(solved_for(linear, first, {w}).cost);
  return out;
}

std::function<double(const Eigen::VectorXd&)> RecordingFit::cost_of(double share) const {
  const auto room = std::make_shared<std::vector<Frame>>();
  const std::vector<Frame>& frames = first_of_training(share, *room);
  return [this, room, &frames](const Eigen::VectorXd& w) { return free_fit(problem(quick(), frames), w).cost; };
}

}  // namespace tissue_stiffness
