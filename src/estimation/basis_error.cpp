#include "estimation/basis_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "filter/posterior_linearization_filter.hpp"
#include "forward/reduced_trajectory.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kComparedFrames = 32;  // frames compared, about
constexpr int kMostGrowths = 4;              // growths of the basis at once, by half each
constexpr double kGrowthHelps = 0.7;         // of the error: a growth that leaves no more is worth another

std::size_t stride(const FitProblem& problem) {
  return (problem.frames.size() + kComparedFrames - 1) / kComparedFrames;
}

}  // namespace

double least_noise(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const ObservationSettings& observation : model.settings().observations) {
    least = std::min(least, observation.noise);
  }
  return least;
}

bool is_checked(std::size_t frame, const FitProblem& problem) {
  return frame % stride(problem) == 0 || frame + 1 == problem.frames.size();
}

BasisError basis_error(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w,
                       const std::vector<int>& nodes) {
  const Eigen::VectorXd theta = problem.model.parameters().theta(w);
  const Eigen::MatrixXd basis = reduced.basis_at(nodes);
  const double delay = problem.model.sensors().delay(theta);
  ReducedTrajectory whole(reduced, theta, problem.start.time), half(reduced, theta, problem.start.time, true);
  double square = 0.0;
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    const double time = problem.frames[k].time - delay;
    whole.advance(time);
    half.advance(time);
    if (!is_checked(k, problem)) continue;
    square = std::max(square, (basis * (whole.coordinates() - half.coordinates())).squaredNorm());
  }
  const double rms = kBasisSafety * std::sqrt(square / static_cast<double>(basis.rows()));
  return {rms, rms / least_noise(problem.model)};
}

BasisGrowth grow_basis(const ReducedModel& reduced, bool exhausted, const FitProblem& problem, const Eigen::VectorXd& w,
                       const std::vector<int>& nodes) {
  BasisGrowth out;
  out.exhausted = exhausted;
  for (const ReducedModel* now = &reduced;; now = out.larger.get()) {
    const double before = out.error.rms;
    out.error = basis_error(*now, problem, w, nodes);
    if (out.exhausted || out.error.sigmas <= kBasisShare) return out;
    const bool helps = out.growths == 0 || out.error.rms < kGrowthHelps * before;
    std::shared_ptr<ReducedModel> larger = out.growths == kMostGrowths || !helps ? nullptr : now->grown();
    out.exhausted = larger == nullptr;
    if (!larger) return out;
    out.larger = std::move(larger);
    ++out.growths;
  }
}

Eigen::VectorXd basis_shift(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w,
                            const Eigen::VectorXd& spread, const Eigen::VectorXd& prior_std) {
  const auto whole = reduced.start(problem.model.parameters().theta(w), problem.start.time);
  const auto half = [&](const Eigen::VectorXd& theta) { return reduced.start_in_half(theta, problem.start.time); };
  return kBasisSafety * fitted_shift(problem, *whole, half, w, spread, prior_std);
}

Eigen::VectorXd fitted_shift(const FitProblem& problem, Trajectory& truth,
                             const std::function<std::unique_ptr<Trajectory>(const Eigen::VectorXd&)>& start,
                             const Eigen::VectorXd& w, const Eigen::VectorXd& spread, const Eigen::VectorXd& prior_std) {
  PosteriorLinearizationFilter filter(w, prior_std.cwiseAbs2().asDiagonal());
  filter.move_anchor(w, spread);
  const Eigen::MatrixXd& points = filter.sigma_points();
  const auto count = static_cast<std::size_t>(points.cols());
  const Eigen::VectorXd theta = problem.model.parameters().theta(w);
  std::vector<Eigen::VectorXd> thetas(count);
  std::vector<std::unique_ptr<Trajectory>> runs(count);
  for (std::size_t i = 0; i < count; ++i) {
    thetas[i] = problem.model.parameters().theta(points.col(static_cast<Eigen::Index>(i)));
    runs[i] = start(thetas[i]);
  }
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    const Frame& frame = problem.frames[k];
    const bool at_this_frame = is_checked(k, problem);
    const auto moved = [&](Trajectory& run, const Eigen::VectorXd& at) {
      run.advance(frame.time - problem.model.sensors().delay(at));
      return at_this_frame ? predict_frame(problem.model, problem.operators, frame, at, run.output()) : Prediction{};
    };
    const Prediction wanted = moved(truth, theta);
    Eigen::MatrixXd rows(wanted.predicted.size(), points.cols());
    for (std::size_t i = 0; i < count; ++i) rows.col(static_cast<Eigen::Index>(i)) = moved(*runs[i], thetas[i]).predicted;
    if (!at_this_frame) continue;
    const Eigen::VectorXd variance = wanted.sigma.cwiseAbs2() / static_cast<double>(stride(problem));
    filter.update(wanted.predicted, rows, variance, Eigen::VectorXd::Ones(variance.size()));
  }
  return filter.mean() - w;
}

}  // namespace tissue_stiffness
