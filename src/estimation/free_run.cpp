#include "tissue_stiffness/estimation/free_run.hpp"

#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/ensemble.hpp"

namespace tissue_stiffness {

Prediction predict_at_rest(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                           const Frame& frame) {
  return predict_frame(model, operators, frame, model.theta(model.prior_mean()), model.rest());
}

std::vector<Misfit> free_run(const FreeRunProblem& problem, Eigen::VectorXd theta, const FreeFrameVisitor& visit,
                             const std::vector<Turn>& turns) {
  const Model& model = problem.model;
  std::vector<Misfit> misfits;
  auto run = problem.forward.begin(theta, problem.start);
  auto turn = turns.begin();
  for (const Frame& frame : problem.frames) {
    for (; turn != turns.end() && turn->time <= frame.time - model.delay(theta); ++turn) {
      run->advance(turn->time);
      run = problem.forward.resume(theta = turn->theta, *run);
    }
    run->advance(frame.time - model.delay(theta));
    const Eigen::VectorXd u = run->displacement();
    const Prediction p = predict_frame(model, problem.operators, frame, theta, u);
    misfits.push_back(
        compare(frame.time, p, predict_at_rest(model, problem.operators, frame).predicted, model.mesh().node_count()));
    if (!visit) continue;
    const auto outline = [&](const Observation& seen) {
      return problem.operators[static_cast<std::size_t>(seen.source)]->outline(seen, u);
    };
    visit({frame, p, misfits.back(), u, outline});
  }
  return misfits;
}

}  // namespace tissue_stiffness
