#include "tissue_stiffness/estimation/basis_error.hpp"

#include <algorithm>
#include <cmath>

#include "tissue_stiffness/estimation/ensemble.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kLooks = 32;  // frames compared

}  // namespace

BasisError basis_error(const ReducedModel& reduced, const FitProblem& problem, const Eigen::VectorXd& w) {
  const Eigen::VectorXd theta = problem.model.theta(w);
  const double delay = problem.model.delay(theta);
  const auto whole = reduced.start(theta, problem.start), half = reduced.start_in_half(theta, problem.start);
  const std::size_t stride = (problem.frames.size() + kLooks - 1) / kLooks;
  BasisError worst;
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    const Frame& frame = problem.frames[k];
    whole->advance(frame.time - delay);
    half->advance(frame.time - delay);
    if (k % stride != 0 && k + 1 != problem.frames.size()) continue;
    const Prediction a = predict_frame(problem.model, problem.operators, frame, theta, whole->displacement()),
                     b = predict_frame(problem.model, problem.operators, frame, theta, half->displacement());
    double square = 0.0, sigmas = 0.0, count = 0.0;
    for (Eigen::Index i = 0; i < a.predicted.size(); ++i) {
      const double off = kBasisDoubt * (a.predicted[i] - b.predicted[i]);
      if (!std::isfinite(off) || !std::isfinite(a.sigma[i])) continue;
      square += off * off;
      sigmas += std::pow(off / a.sigma[i], 2);
      count += 1.0;
    }
    if (count == 0.0) continue;
    worst.rms = std::max(worst.rms, std::sqrt(square / count));
    worst.sigmas = std::max(worst.sigmas, std::sqrt(sigmas / count));
  }
  return worst;
}

}  // namespace tissue_stiffness
