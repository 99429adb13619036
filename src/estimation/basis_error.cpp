#include "tissue_stiffness/estimation/basis_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kLooks = 32;  // frames compared

double least_noise(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const ObservationSettings& observation : model.settings().observations) {
    least = std::min(least, observation.noise);
  }
  return least;
}

}  // namespace

BasisError basis_error(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w) {
  const Eigen::VectorXd theta = problem.model.theta(w);
  const double delay = problem.model.delay(theta);
  const auto whole = reduced.start(theta, problem.start.time), half = reduced.start_in_half(theta, problem.start.time);
  const std::size_t stride = (problem.frames.size() + kLooks - 1) / kLooks;
  double square = 0.0;
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    const double time = problem.frames[k].time - delay;
    whole->advance(time);
    half->advance(time);
    if (k % stride != 0 && k + 1 != problem.frames.size()) continue;
    square = std::max(square, (whole->displacement() - half->displacement()).squaredNorm());
  }
  const double rms = kBasisDoubt * std::sqrt(square / (3.0 * reduced.nodes_in_focus()));
  return {rms, rms / least_noise(problem.model)};
}

}  // namespace tissue_stiffness
