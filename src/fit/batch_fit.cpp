#include "fit/batch_fit.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "observation/frame_misfit.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 25;
constexpr int kMostCuts = 5;
constexpr double kCut = 0.3;
constexpr double kLeastDamping = 1e-3;  // of the information's diagonal, once a step has failed
constexpr double kHarder = 10.0;        // its factor after each further failure
constexpr double kLongestStep = 1.0;    // prior standard deviations at once
constexpr double kSmallStep = 0.02;     // posterior standard deviations: converged
constexpr double kFloor = 1e-4;         // of the prior's standard deviation: smallest span of the sigma points
constexpr double kGain = 1e-5;          // relative fall of the cost below which the fit ends
constexpr double kEasier = 3.0;         // divides the damping after a step that needed no cut
constexpr double kHope = 20.0;          // times the last fall: what a fit may still fall by
constexpr int kTried = 2;               // moves before the rival may end the fit
constexpr std::size_t kRemembered = 3;  // steps that the next one is extrapolated from
constexpr double kNarrower = 0.7;       // of the sigma points' span: one that stays wider would repeat the failed step

using Parts = std::vector<FitPart>;

// Returns the sigma points of one recording. A point that moves only another recording's parameters is its central one.
Eigen::MatrixXd own_points(const PosteriorLinearizationFilter& filter, const std::vector<Eigen::Index>& columns) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd out(count, 2 * count + 1);
  for (Eigen::Index row = 0; row < count; ++row)
    out.row(row).setConstant(filter.anchor()[columns[static_cast<std::size_t>(row)]]);
  for (Eigen::Index i = 0; i < count; ++i) {
    out(i, 1 + i) += filter.spread()[columns[static_cast<std::size_t>(i)]];
    out(i, 1 + count + i) -= filter.spread()[columns[static_cast<std::size_t>(i)]];
  }
  return out;
}

// Returns the predictions at the sigma points of all recordings.
Eigen::MatrixXd at_all_points(const Eigen::MatrixXd& own, const std::vector<Eigen::Index>& columns, Eigen::Index all) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd out = own.col(0).replicate(1, 2 * all + 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    out.col(1 + columns[static_cast<std::size_t>(i)]) = own.col(1 + i);
    out.col(1 + all + columns[static_cast<std::size_t>(i)]) = own.col(1 + count + i);
  }
  return out;
}

void run(const Parts& parts, PosteriorLinearizationFilter& filter, const Eigen::VectorXd& anchor,
         const Eigen::VectorXd& spread) {
  filter.move_anchor(anchor, spread);
  for (const FitPart& part : parts) {
    Ensemble ensemble(part.problem.model, part.problem.forward, part.problem.operators);
    ensemble.restart(own_points(filter, part.columns), part.problem.start);
    for (const Frame& frame : part.problem.frames) {
      part.problem.checkpoint();
      ensemble.advance(frame.time);
      const Ensemble::Predicted p = ensemble.predict(frame);
      filter.update(p.central.measured, at_all_points(p.rows, part.columns, anchor.size()),
                    part.noise * p.central.sigma.cwiseAbs2(), row_weights(p.central));
    }
  }
}

// Returns each parameter's standard deviation with the others held. Where parameters compensate each other, one that moves
// alone by its own standard deviation is far from what the data allow, and no linearisation holds there.
Eigen::VectorXd std_of_each(const PosteriorLinearizationFilter& filter) {
  const Eigen::Index p = filter.anchor().size();
  return filter.covariance().ldlt().solve(Eigen::MatrixXd::Identity(p, p)).diagonal().cwiseSqrt().cwiseInverse();
}

// Shortens a move as a whole where it is too long, because parameters that compensate each other have to move together.
Eigen::VectorXd shortened(const Eigen::VectorXd& move, const Eigen::VectorXd& prior) {
  return move / std::max(1.0, (move.array() / prior.array()).abs().maxCoeff() / kLongestStep);
}

double cost_at(const Parts& parts, const PosteriorLinearizationFilter& filter, const Eigen::VectorXd& w) {
  const FreeFit there = free_fit(parts, w);
  return filter.cost_at(w, there.cost, there.rows);
}

// Returns by how much a whole step would lower the cost if the model were linear.
double promise(const PosteriorLinearizationFilter& filter) {
  const Eigen::VectorXd move = filter.mean() - filter.anchor();
  return filter.misfit_scale() * move.dot(filter.covariance().ldlt().solve(move));
}

// Where errors stay large, Gauss-Newton's steps shrink slowly, and each is nearly a linear map of the last. So the last
// steps tell where the iteration ends (Anderson 1965).
class Extrapolation {
 public:
  // Returns the step from `at` where Gauss-Newton has `step`; `scale` is a unit of each parameter.
  Eigen::VectorXd operator()(const Eigen::VectorXd& at, const Eigen::VectorXd& step, const Eigen::VectorXd& scale) {
    Eigen::VectorXd out = step;
    if (const auto count = static_cast<Eigen::Index>(past_.size()); count > 0) {
      Eigen::MatrixXd moves(step.size(), count), changes(step.size(), count);
      for (Eigen::Index i = 0; i < count; ++i) {
        moves.col(i) = at - past_[static_cast<std::size_t>(i)].at;
        changes.col(i) = step - past_[static_cast<std::size_t>(i)].step;
      }
      const Eigen::VectorXd inverse = scale.cwiseInverse();
      const Eigen::VectorXd share =
          (inverse.asDiagonal() * changes).colPivHouseholderQr().solve(inverse.cwiseProduct(step));
      out -= (moves + changes) * share;
    }
    past_.push_back({at, step});
    if (past_.size() > std::min(kRemembered, static_cast<std::size_t>(step.size()))) past_.erase(past_.begin());
    return out;
  }
  void forget() { past_.clear(); }

 private:
  struct Step {
    Eigen::VectorXd at, step;
  };
  std::vector<Step> past_;
};

}  // namespace

FreeFit free_fit(const Parts& parts, const Eigen::VectorXd& w) {
  FreeFit sum;
  for (const FitPart& part : parts) {
    Eigen::VectorXd own(static_cast<Eigen::Index>(part.columns.size()));
    for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = w[part.columns[static_cast<std::size_t>(i)]];
    const FreeFit fit = free_fit(part.problem, own);
    sum.cost += fit.cost / part.noise;
    sum.rows += fit.rows;
  }
  return sum;
}

PosteriorLinearizationFilter fit_filter(const FitProblem& problem, PosteriorLinearizationFilter filter,
                                        const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double rival) {
  std::vector<Eigen::Index> columns(problem.model.parameters().free().size());
  std::iota(columns.begin(), columns.end(), 0);
  return fit_filter(Parts{{problem, std::move(columns)}}, std::move(filter), start, spread, rival);
}

PosteriorLinearizationFilter fit_filter(const Parts& parts, PosteriorLinearizationFilter filter,
                                        const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double rival) {
  const Eigen::VectorXd prior = filter.spread();
  double damping = 0.0;
  bool careful = false;
  Extrapolation extrapolate;
  run(parts, filter, start, spread);
  for (int k = 0; k < kMostIterations; ++k) {
    const PosteriorLinearizationFilter before = filter;
    const Eigen::VectorXd std = before.covariance().diagonal().cwiseSqrt();
    if (((before.mean() - before.anchor()).array().abs() < kSmallStep * std.array()).all()) break;
    const Eigen::VectorXd each = std_of_each(before);
    const Eigen::VectorXd next = (2.0 * each).cwiseMin(before.spread()).cwiseMax(kFloor * prior);
    const auto lowers = [&](const Eigen::VectorXd& to, bool only_if_lower) {
      if (only_if_lower && !(cost_at(parts, before, to) < before.cost())) return false;
      run(parts, filter, to, next);
      return filter.cost() < before.cost();
    };
    const double promised = promise(before);
    bool further = false;
    if (damping > 0.0) {
      extrapolate.forget();
    } else if (const Eigen::VectorXd step = before.mean() - before.anchor(), to = extrapolate(before.anchor(), step, each);
               to != step) {
      further = lowers(before.anchor() + shortened(to, prior), false);
      careful = !further;
      if (!further) extrapolate.forget();
    }
    bool better = further;
    int tried = 0;
    const int most = promised < kGain * before.cost() ? 1 : kMostCuts;
    for (double cut = 1.0; tried < most && !better; ++tried, cut *= kCut) {
      if (tried > 0) damping = std::max(kLeastDamping, kHarder * damping);
      const Eigen::VectorXd step = shortened(before.mean(damping) - before.anchor(), prior);
      better = lowers(before.anchor() + cut * step, careful || tried > 0);
    }
    careful = tried > 1;
    if (!better) {
      filter = before;
      if ((next.array() > kNarrower * before.spread().array()).all()) break;
      run(parts, filter, before.anchor(), next);
      continue;
    }
    const double gain = before.cost() - filter.cost();
    if ((further ? std::max(gain, promised) : gain) < kGain * before.cost()) break;  // one that overshot gains little, too
    if (k >= kTried && filter.cost() - kHope * gain > rival) break;
    if (tried == 1) damping = damping > kLeastDamping ? damping / kEasier : 0.0;
  }
  return filter;
}

BatchFit fit_batch(const FitProblem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double rival) {
  const Eigen::VectorXd prior = problem.model.parameters().prior_std();
  const PosteriorLinearizationFilter filter = fit_filter(
      problem, PosteriorLinearizationFilter(problem.model.parameters().prior_mean(), prior.cwiseAbs2().asDiagonal()), start,
      spread, rival);
  return {filter.anchor(), filter.covariance(), filter.cost()};
}

}  // namespace tissue_stiffness
