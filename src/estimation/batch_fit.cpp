#include "tissue_stiffness/estimation/batch_fit.hpp"

#include <algorithm>

#include "tissue_stiffness/estimation/compare.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 25;
constexpr int kMostCuts = 5;
constexpr double kCut = 0.3;
constexpr double kLeastDamping = 1e-3;  // of the information's diagonal, once a step has failed
constexpr double kHarder = 10.0;        // times that after each more
constexpr double kLongestStep = 1.0;    // prior standard deviations at once
constexpr double kSmallStep = 0.02;     // posterior standard deviations: converged
constexpr double kFloor = 1e-4;         // of the prior's standard deviation: smallest span of the sigma points
constexpr double kGain = 1e-5;          // relative fall of the cost below which it is over
constexpr double kNarrower = 0.7;       // of the sigma points' span: with more than that a step comes out as it did

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

// Were the others known: where parameters make up for one another, a point that moves one of them by its own standard
// deviation is far from what the data allow, and no line passes there.
Eigen::VectorXd std_of_each(const AnchoredFilter& filter) {
  const Eigen::Index p = filter.anchor().size();
  return filter.covariance().ldlt().solve(Eigen::MatrixXd::Identity(p, p)).diagonal().cwiseSqrt().cwiseInverse();
}

// Shortened as a whole where it is too long: parameters that make up for one another have to move together.
Eigen::VectorXd step(const AnchoredFilter& filter, double damping, const Eigen::VectorXd& prior) {
  const Eigen::VectorXd move = filter.mean(damping) - filter.anchor();
  return move / std::max(1.0, (move.array() / prior.array()).abs().maxCoeff() / kLongestStep);
}

}  // namespace

AnchoredFilter fit_filter(const FitProblem& problem, AnchoredFilter filter, const Eigen::VectorXd& start,
                          const Eigen::VectorXd& spread) {
  const Eigen::VectorXd prior = filter.spread();
  double damping = 0.0;
  run(problem, filter, start, spread);
  for (int k = 0; k < kMostIterations; ++k) {
    const AnchoredFilter before = filter;
    const Eigen::VectorXd std = before.covariance().diagonal().cwiseSqrt();
    if (((before.mean() - before.anchor()).array().abs() < kSmallStep * std.array()).all()) break;
    const Eigen::VectorXd next = (2.0 * std_of_each(before)).cwiseMin(before.spread()).cwiseMax(kFloor * prior);
    bool better = false;
    int tried = 0;
    for (double cut = 1.0; tried < kMostCuts && !better; ++tried, cut *= kCut) {
      if (tried > 0) damping = std::max(kLeastDamping, kHarder * damping);
      run(problem, filter, before.anchor() + cut * step(before, damping, prior), next);
      better = filter.cost() < before.cost();
    }
    if (!better) {
      filter = before;
      if ((next.array() > kNarrower * before.spread().array()).all()) break;
      run(problem, filter, before.anchor(), next);
      continue;
    }
    if (before.cost() - filter.cost() < kGain * before.cost()) break;
    if (tried == 1) damping = damping > kLeastDamping ? damping / kHarder : 0.0;
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
