#include "tissue_stiffness/estimation/choose_correction.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/coordinate_scan.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kPoints = 12;        // on either side of the prior's mean, for corrected runs
constexpr int kFreePoints = 25;    // for free ones, whose likelihood is rougher
constexpr double kReplaced = 4.0;  // times the free run's misfit, beyond which corrected runs no longer follow the model
constexpr double kLevels[] = {0.3, 0.1, 0.03, 0.01};  // of the modal forces at work
constexpr double kSearchLevel = 0.1;

using Field = Eigen::Ref<const Eigen::VectorXd>;

Eigen::ArrayXd errors(const Prediction& p) {
  return ((p.measured - p.predicted).cwiseQuotient(p.sigma)).array();
}

}  // namespace

void run_freely(const FitProblem& problem, const Eigen::VectorXd& w, const ShowFrame& show) {
  const Eigen::VectorXd theta = problem.model.theta(w);
  const double delay = problem.model.delay(theta);
  const auto run = problem.forward.begin(theta, problem.start);
  std::vector<double> times;
  for (const Frame& frame : problem.frames) times.push_back(frame.time - delay);
  problem.forward.advance_through(*run, times, [&](std::size_t k, const Field& displacement) {
    problem.checkpoint();
    show(problem.frames[k], theta, displacement);
  });
}

FreeFit fit_frame(const FitProblem& problem, const Frame& frame, const Eigen::VectorXd& theta,
                  const Eigen::Ref<const Eigen::VectorXd>& displacement) {
  const Prediction p = predict_frame(problem.model, problem.operators, frame, theta, displacement);
  const Eigen::ArrayXd weights = row_weights(p).array();
  return {(weights > 0.0).select(weights * errors(p).square(), 0.0).sum(), static_cast<double>((weights > 0.0).count())};
}

FreeFit free_fit(const FitProblem& problem, const Eigen::VectorXd& w) {
  FreeFit fit;
  run_freely(problem, w, [&](const Frame& frame, const Eigen::VectorXd& theta, const Field& displacement) {
    const FreeFit now = fit_frame(problem, frame, theta, displacement);
    fit.cost += now.cost;
    fit.rows += now.rows;
  });
  return fit;
}

double motion_cost(const FitProblem& problem, const Eigen::VectorXd& w) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(problem.model.fem().dof_count());
  double cost = 0.0;
  run_freely(problem, w, [&](const Frame& frame, const Eigen::VectorXd& theta, const Field& displacement) {
    const auto predict = [&](const Field& u) { return predict_frame(problem.model, problem.operators, frame, theta, u); };
    const Eigen::ArrayXd weights = row_weights(predict(displacement)).array(), motion = errors(predict(rest));
    cost += (weights > 0.0 && motion.isFinite()).select(weights * motion.square(), 0.0).sum();
  });
  return cost;
}

std::optional<Correction> choose_correction(const FitProblem& problem, const Eigen::VectorXd& w) {
  const Model& model = problem.model;
  const double free = free_fit(problem, w).cost;
  const double scale = modal_force_scale(model, problem.forward, problem.frames, w, problem.start.time);
  // Where the corrections would replace the model, the likelihood says nothing about its parameters.
  const auto deviance = [&](const Eigen::VectorXd& x, double force) {
    if (free_fit(problem, x).cost > kReplaced * free) return std::numeric_limits<double>::infinity();
    return CorrectedRuns(model, problem.forward, problem.operators, force).deviance(problem.frames, x, problem.start.time);
  };
  const auto scan = [&](const std::function<double(const Eigen::VectorXd&)>& cost, int points) {
    return scan_coordinates(cost, w, model.prior_mean(), model.prior_std(), points);
  };
  std::vector<ScanResult> places{{w, Eigen::VectorXd::Zero(w.size()), free, false}};
  places.push_back(scan([&](const Eigen::VectorXd& x) { return free_fit(problem, x).cost; }, kFreePoints));
  places.push_back(scan([&](const Eigen::VectorXd& x) { return deviance(x, kSearchLevel * scale); }, kPoints));
  std::optional<Correction> best;
  double lowest = free;
  for (const ScanResult& place : places) {
    for (const double level : kLevels) {
      const double value = deviance(place.best, level * scale);
      if (!(value < lowest)) continue;
      lowest = value;
      best = Correction{place.best, place.step, level * scale};
    }
  }
  return best;
}

}  // namespace tissue_stiffness
