#include "tissue_stiffness/estimation/batch_fit.hpp"

#include "tissue_stiffness/estimation/compare.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 25;
constexpr int kMostCuts = 5;
constexpr double kLongestStep = 1.0;  // prior standard deviations at once
constexpr double kSmallStep = 0.02;   // posterior standard deviations: converged
constexpr double kFloor = 1e-4;       // of the prior's standard deviation: smallest span of the sigma points
constexpr double kGain = 1e-5;        // relative fall of the cost below which it is over
constexpr double kNarrower = 0.7;     // of the sigma points' span: with more than that a step comes out as it did

void run(const FitProblem& problem, AnchoredFilter& filter, const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread) {
  filter.move_anchor(anchor, spread);
  Ensemble ensemble(problem.model, problem.forward, problem.operators);
  ensemble.restart(filter.sigma_points(), problem.start);
  for (const Frame& frame : problem.frames) {
    problem.checkpoint();
    ensemble.advance(frame.time);
    const Ensemble::Predicted p = ensemble.predict(frame);
    filter.update(p.central.measured, p.rows, p.central.sigma.cwiseAbs2(), row_weights(p.central));
  }
}

}  // namespace

AnchoredFilter fit_filter(const FitProblem& problem, AnchoredFilter filter, const Eigen::VectorXd& start,
                          const Eigen::VectorXd& spread) {
  const Eigen::VectorXd prior = filter.spread();
  run(problem, filter, start, spread);
  for (int k = 0; k < kMostIterations; ++k) {
    const Eigen::VectorXd std = filter.covariance().diagonal().cwiseSqrt();
    const Eigen::VectorXd limit = kLongestStep * prior;
    Eigen::VectorXd move = (filter.mean() - filter.anchor()).cwiseMax(-limit).cwiseMin(limit);
    if ((move.array().abs() < kSmallStep * std.array()).all()) break;
    const Eigen::VectorXd next = (2.0 * std).cwiseMin(filter.spread()).cwiseMax(kFloor * prior);
    const AnchoredFilter before = filter;
    bool better = false;
    for (int cut = 0; cut < kMostCuts && !better; ++cut, move *= 0.3) {
      run(problem, filter, before.anchor() + move, next);
      better = filter.cost() < before.cost();
    }
    if (!better) {
      filter = before;
      if ((next.array() > kNarrower * before.spread().array()).all()) break;
      run(problem, filter, before.anchor(), next);
      continue;
    }
    if (before.cost() - filter.cost() < kGain * before.cost()) break;
  }
  return filter;
}

BatchFit fit_batch(const FitProblem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& spread) {
  const Eigen::VectorXd prior = problem.model.prior_std();
  const AnchoredFilter filter =
      fit_filter(problem, AnchoredFilter(problem.model.prior_mean(), prior.cwiseAbs2().asDiagonal()), start, spread);
  return {filter.anchor(), filter.covariance(), filter.cost()};
}

}  // namespace tissue_stiffness
