#include "estimation/force_noise.hpp"

#include <algorithm>

#include "observation/frame_misfit.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

/// Calls `act(observation, first row)` for each force of a frame.
template <typename Act>
void each_force(const Frame& frame, const Act& act) {
  Eigen::Index first = 0;
  for (const Observation& observation : frame.observations) {
    if (traits_of(observation.kind).force) act(observation, first);
    first += observation.row_count();
  }
}

}  // namespace

ForceNoise::ForceNoise(const std::vector<ObservationSettings>& sensors, const std::vector<Frame>& frames) {
  std::map<int, std::vector<double>> times;
  for (const Frame& frame : frames) {
    each_force(frame, [&](const Observation& force, Eigen::Index) {
      const double sigma = sensors[static_cast<std::size_t>(force.source)].noise;
      measured_[force.source].add(frame.time, force.points.col(0) / sigma);
      times[force.source].push_back(frame.time);
    });
  }
  for (const auto& [sensor, noise] : measured_) {
    const Eigen::VectorXd weights = noise.weights();
    for (std::size_t k = 0; k < times[sensor].size(); ++k)
      weights_[sensor][times[sensor][k]] = weights[static_cast<Eigen::Index>(k)];
  }
}

std::vector<Eigen::Index> ForceNoise::note(const Frame& frame, const Prediction& prediction,
                                           const Eigen::VectorXd& residual) {
  std::vector<Eigen::Index> out;
  each_force(frame, [&](const Observation& force, Eigen::Index first) {
    const Eigen::Index count = force.row_count();
    residual_[force.source].add(frame.time,
                                residual.segment(first, count).cwiseQuotient(prediction.sigma.segment(first, count)));
    for (Eigen::Index i = 0; i < count; ++i) out.push_back(first + i);
  });
  return out;
}

std::map<int, double> ForceNoise::found() const {
  std::map<int, double> out;
  for (const auto& [sensor, noise] : measured_) {
    const auto residual = residual_.find(sensor);
    out[sensor] = residual == residual_.end() ? noise.variance() : std::min(noise.variance(), residual->second.variance());
  }
  return out;
}

Eigen::VectorXd ForceNoise::precision(const Frame& frame, const Prediction& prediction) const {
  Eigen::VectorXd out = row_weights(prediction).cwiseQuotient(prediction.sigma.cwiseAbs2());
  each_force(frame, [&](const Observation& force, Eigen::Index first) {
    const auto variance = variance_.find(force.source);
    const double weight = weights_.at(force.source).at(frame.time) / (variance == variance_.end() ? 1.0 : variance->second);
    const Eigen::Index count = force.row_count();
    out.segment(first, count) = weight * prediction.sigma.segment(first, count).cwiseAbs2().cwiseInverse();
  });
  return out;
}

}  // namespace tissue_stiffness
