#pragma once

#include <random>
#include <vector>

#include "forward/full_model.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// Returns what a sensor feels of the last reaction of a model whose loads are known: `count` frames, `interval` s apart,
/// integrated in full with this step [s], with noise [N].
inline std::vector<Frame> felt_forces(const Model& model, double step, double interval, int count, double noise) {
  FullModel::Options options;
  options.step = step;
  const FullModel full(model, options);
  const auto run = full.start(model.parameters().theta(Eigen::VectorXd(0)), 0.0);
  std::mt19937 random(5);
  std::normal_distribution<double> error(0.0, noise);
  std::vector<Frame> frames;
  for (int k = 1; k <= count; ++k) {
    run->advance(interval * k);
    Observation force;
    force.kind = ObservationKind::reaction;
    force.time = interval * k;
    force.points = run->output().tail<3>();
    for (int i = 0; i < 3; ++i) force.points(i, 0) += error(random);
    frames.push_back({force.time, {force}});
  }
  return frames;
}

}  // namespace tissue_stiffness
