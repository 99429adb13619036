#include "estimation/posterior.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

FreeParameter parameter(const std::string& name, Quantity::Kind kind) {
  FreeParameter out;
  out.name = name;
  out.prior.kind = kind;
  return out;
}

// The filter's coordinate of a modulus is its logarithm, while the covariance is published in the parameters' units.
TEST(Posterior, TheCovarianceHasTheUnitsOfTheParameters) {
  const std::vector<FreeParameter> parameters{parameter("elasticity.young_modulus", Quantity::Kind::log_normal),
                                              parameter("rigid_drift.x", Quantity::Kind::normal)};
  Eigen::MatrixXd covariance(2, 2);
  covariance << 0.01, -0.03, -0.03, 0.25;
  const Estimate estimate = summarise_posterior(parameters, Eigen::Vector2d(std::log(12e3), 2.0), covariance);
  const ParameterEstimate &modulus = estimate.parameters[0], &drift = estimate.parameters[1];
  EXPECT_NEAR(modulus.mean, 12e3 * std::exp(0.005), 1e-6);
  EXPECT_NEAR(modulus.std, modulus.mean * std::sqrt(std::exp(0.01) - 1.0), 1e-6);
  EXPECT_NEAR(modulus.upper95, 12e3 * std::exp(0.1 * 1.959964), 1e-2);
  EXPECT_NEAR(drift.std, 0.5, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 0), modulus.std * modulus.std, 1e-6);
  EXPECT_NEAR(estimate.covariance(1, 1), drift.std * drift.std, 1e-12);
  EXPECT_NEAR(estimate.covariance(0, 1), -0.6 * modulus.std * drift.std, 1e-9);
  EXPECT_EQ(estimate.covariance(0, 1), estimate.covariance(1, 0));
}

}  // namespace
}  // namespace tissue_stiffness
