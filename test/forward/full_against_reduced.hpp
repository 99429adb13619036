#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// Largest difference between the two over the frames, at nodes of the surface, over the largest motion there.
inline double full_against_reduced(const Model& model, const ReducedModel& reduced, const Eigen::VectorXd& theta,
                                   double step) {
  FullModel::Options options;
  options.step = step;
  options.spectral_radius = 1.0;
  const FullModel full(model, options);
  const auto a = full.start(theta, 0.1), b = reduced.start(theta, 0.1);
  double error = 0.0, motion = 0.0;
  for (int k = 1; k <= 24; ++k) {
    a->advance(0.1 + 0.016 * k);
    b->advance(0.1 + 0.016 * k);
    EXPECT_EQ(a->time(), b->time());
    const Eigen::VectorXd u = a->displacement(), e = b->displacement() - u;
    for (Eigen::Index i = 0; i < model.mesh().facets.size(); ++i) {
      const int node = model.mesh().facets(i);
      error = std::max(error, e.segment<3>(3 * node).norm());
      motion = std::max(motion, u.segment<3>(3 * node).norm());
    }
  }
  EXPECT_GT(motion, 1e-3);
  return error / motion;
}

}  // namespace tissue_stiffness
