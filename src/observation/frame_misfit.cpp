#include "observation/frame_misfit.hpp"

#include <cmath>

#include "filter/robust_weights.hpp"

namespace tissue_stiffness {
Eigen::VectorXd row_weights(const Prediction& p) {
  const Eigen::VectorXd e = (p.measured - p.predicted).cwiseQuotient(p.sigma);
  Eigen::VectorXd weights = robust_weights(e);
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    if (!std::isfinite(e[i])) weights[i] = 0.0;
  }
  return weights;
}

Misfit frame_misfit(double time, const Prediction& p, const Eigen::VectorXd& rest, int node_count) {
  Misfit misfit;
  misfit.time = time;
  const Eigen::VectorXd weights = row_weights(p);
  Eigen::VectorXd &square = misfit.node_error, &sigmas = misfit.node_sigmas, count = Eigen::VectorXd::Zero(node_count);
  square = sigmas = count;
  double error = 0.0, relative = 0.0, motion = 0.0;
  for (Eigen::Index i = 0; i < p.measured.size(); ++i) {
    const double e = p.measured[i] - p.predicted[i];
    if (!std::isfinite(e) || !std::isfinite(p.sigma[i])) continue;
    ++misfit.count;
    if (weights[i] < 0.5) ++misfit.outliers;
    relative += std::pow(e / p.sigma[i], 2);
    if (p.nodes[i] == kForceRow) continue;
    ++misfit.lengths;
    error += e * e;
    const double moved = p.measured[i] - rest[i];
    if (std::isfinite(moved)) motion += moved * moved;
    square[p.nodes[i]] += e * e;
    sigmas[p.nodes[i]] += std::pow(e / p.sigma[i], 2);
    count[p.nodes[i]] += 1.0;
  }
  if (misfit.count > 0) misfit.rms_sigma = std::sqrt(relative / misfit.count);
  if (misfit.lengths > 0) {
    misfit.rms = std::sqrt(error / misfit.lengths);
    misfit.motion_rms = std::sqrt(motion / misfit.lengths);
  }
  square = (square.array() / count.array()).sqrt();  // 0/0: NaN where nothing was measured
  sigmas = (sigmas.array() / count.array()).sqrt();
  return misfit;
}

}  // namespace tissue_stiffness
