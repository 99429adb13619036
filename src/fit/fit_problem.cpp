#include "fit/fit_problem.hpp"

#include "observation/frame_misfit.hpp"

namespace tissue_stiffness {
namespace {

using Field = Eigen::Ref<const Eigen::VectorXd>;

Eigen::ArrayXd errors(const Prediction& p) {
  return ((p.measured - p.predicted).cwiseQuotient(p.sigma)).array();
}

}  // namespace

void run_freely(const FitProblem& problem, const Eigen::VectorXd& w, const ShowFrame& show) {
  const Eigen::VectorXd theta = problem.model.parameters().theta(w);
  const double delay = problem.model.sensors().delay(theta);
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

}  // namespace tissue_stiffness
