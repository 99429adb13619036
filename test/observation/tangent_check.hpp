#pragma once

#include <gtest/gtest.h>

#include "observation/observation_operator.hpp"

namespace tissue_stiffness {

/// Compares a sensor's tangent at u with central differences along seeded directions.
inline void expect_tangent(const ObservationOperator& sensor, const Observation& observation, const Eigen::VectorXd& u) {
  constexpr double kStep = 1e-7;  // [m]
  const std::optional<RowTangent> tangent = sensor.tangent(observation, u);
  ASSERT_TRUE(tangent);
  std::srand(5);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd along = Eigen::VectorXd::Random(u.size());
    const Eigen::VectorXd differences = (sensor.predict(observation, u + kStep * along).predicted -
                                         sensor.predict(observation, u - kStep * along).predicted) /
                                        (2.0 * kStep);
    ASSERT_TRUE(differences.allFinite());
    const Eigen::VectorXd rows = *tangent * along;
    EXPECT_LT((rows - differences).cwiseAbs().maxCoeff(), 1e-5) << rows.transpose() << "\n" << differences.transpose();
    EXPECT_GT(differences.cwiseAbs().maxCoeff(), 1e-2);
  }
}

}  // namespace tissue_stiffness
