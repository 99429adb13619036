#include "fit/free_run.hpp"

#include "fit/ensemble.hpp"
#include "observation/frame_misfit.hpp"

namespace tissue_stiffness {

std::vector<Misfit> free_run(const FitProblem& problem, Eigen::VectorXd theta, const FreeFrameVisitor& visit,
                             const std::vector<ParameterChange>& changes) {
  const Model& model = problem.model;
  std::vector<Misfit> misfits;
  auto run = problem.forward.begin(theta, problem.start);
  auto change = changes.begin();
  for (const Frame& frame : problem.frames) {
    for (; change != changes.end() && change->time <= frame.time - model.sensors().delay(theta); ++change) {
      run->advance(change->time);
      run = problem.forward.resume(theta = change->theta, *run);
    }
    run->advance(frame.time - model.sensors().delay(theta));
    const Eigen::VectorXd output = run->output(), u = output.head(model.fem().dof_count());
    const Prediction p = predict_frame(model, problem.operators, frame, theta, output);
    misfits.push_back(
        frame_misfit(frame.time, p, predict_at_rest(model, problem.operators, frame).predicted, model.mesh().node_count()));
    if (!visit) continue;
    const auto outline = [&](const Observation& seen) {
      return problem.operators[static_cast<std::size_t>(seen.source)]->outline(seen, u);
    };
    visit({frame, p, misfits.back(), u, outline});
  }
  return misfits;
}

}  // namespace tissue_stiffness
