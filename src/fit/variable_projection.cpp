#include "fit/variable_projection.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "fit/ensemble.hpp"
#include "observation/frame_misfit.hpp"

namespace tissue_stiffness {

Eigen::VectorXd variable_projection(const FitProblem& problem, const Eigen::VectorXd& w,
                                    const std::vector<Eigen::Index>& linear) {
  const auto count = static_cast<Eigen::Index>(linear.size());
  const Eigen::VectorXd mean = problem.model.parameters().prior_mean(), std = problem.model.parameters().prior_std();
  Eigen::MatrixXd points = w.replicate(1, 1 + count);
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd pull(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = linear[static_cast<std::size_t>(i)];
    points(k, 1 + i) += std[k];
    pull[i] = (mean[k] - w[k]) / std[k];
  }
  Ensemble ensemble(problem.model, problem.forward, problem.operators);
  ensemble.restart(points, problem.start);
  for (const Frame& frame : problem.frames) {
    problem.checkpoint();
    ensemble.advance(frame.time);
    const Ensemble::Predicted p = ensemble.predict(frame);
    const Eigen::VectorXd weights = row_weights(p.central);
    for (Eigen::Index r = 0; r < weights.size(); ++r) {
      if (!(weights[r] > 0.0)) continue;
      const double scale = std::sqrt(weights[r]) / p.central.sigma[r];
      const Eigen::VectorXd change = scale * (p.rows.row(r).tail(count).array() - p.rows(r, 0)).matrix().transpose();
      information += change * change.transpose();
      pull += scale * (p.central.measured[r] - p.rows(r, 0)) * change;
    }
  }
  const Eigen::VectorXd move = information.ldlt().solve(pull);
  Eigen::VectorXd out = w;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = linear[static_cast<std::size_t>(i)];
    out[k] += std[k] * move[i];
  }
  return out;
}

}  // namespace tissue_stiffness
