#include "filter/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "filter/interval.hpp"
#include "filter/robust_weights.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

Eigen::VectorXd normal_rows(Eigen::Index count, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(count, [&] { return normal(engine); });
}

TEST(ChiSquared, ClosedForms) {
  for (const double x : {1e-3, 0.3, 1.0, 2.0, 5.0, 30.0}) {
    EXPECT_NEAR(chi_squared_cdf(x, 2), -std::expm1(-0.5 * x), 1e-15);
    EXPECT_NEAR(chi_squared_cdf(x, 1), std::erf(std::sqrt(0.5 * x)), 1e-15);
    EXPECT_NEAR(chi_squared_cdf(x, 4), 1.0 - std::exp(-0.5 * x) * (1.0 + 0.5 * x), 1e-14);
  }
  EXPECT_EQ(chi_squared_cdf(0.0, 3), 0.0);
  EXPECT_EQ(chi_squared_cdf(std::numeric_limits<double>::infinity(), 3), 1.0);
}

TEST(ChiSquared, Tables) {
  EXPECT_NEAR(chi_squared_quantile(0.95, 1), 3.841458820694124, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(0.95, 10), 18.307038053275146, 1e-11);
  EXPECT_NEAR(chi_squared_quantile(0.01, 30), 14.953456528455443, 1e-11);
  EXPECT_NEAR(chi_squared_quantile(0.975, 100), 129.56119718583659, 1e-10);
}

TEST(ChiSquared, QuantileInvertsTheCdf) {
  for (const double dof : {0.5, 1.0, 7.0, 300.0, 1e5, 2e6}) {
    for (const double p : {0.001, 0.025, 0.5, 0.975, 0.999}) {
      EXPECT_NEAR(chi_squared_cdf(chi_squared_quantile(p, dof), dof), p, 1e-8) << dof;
    }
  }
}

TEST(ChiSquared, ManyRowsApproachTheNormal) {
  const double dof = 1e6;
  const double x = dof + 2.0 * std::sqrt(2.0 * dof);
  EXPECT_NEAR(chi_squared_cdf(x, dof), normal_cdf(2.0), 1e-3);
  EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-15);
}

TEST(PValue, BothSidesCount) {
  EXPECT_NEAR(two_sided_p_value(chi_squared_quantile(0.975, 12), 12), 0.05, 1e-10);
  EXPECT_NEAR(two_sided_p_value(chi_squared_quantile(0.025, 12), 12), 0.05, 1e-10);
  EXPECT_GT(two_sided_p_value(chi_squared_quantile(0.5, 12), 12), 0.999);
  EXPECT_GT(two_sided_p_value(900.0, 100.0), 0.0);  // far tail: tiny, not rounded to zero
  EXPECT_LT(two_sided_p_value(900.0, 100.0), 1e-100);
  EXPECT_EQ(two_sided_p_value(0.0, 5.0), 0.0);
  EXPECT_THROW(two_sided_p_value(std::nan(""), 5.0), std::invalid_argument);
  EXPECT_THROW(chi_squared_quantile(1.0, 5.0), std::invalid_argument);
}

TEST(PValue, IsUniformForNormalErrors) {
  int below = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    if (two_sided_p_value(normal_rows(20, seed).squaredNorm(), 20) < 0.1) ++below;
  }
  EXPECT_NEAR(below, 200, 45);  // 3.3 standard deviations
}

TEST(Consistency, SumsUp) {
  ConsistencySum sum;
  EXPECT_EQ(sum.p_value(), 1.0);
  EXPECT_TRUE(std::isnan(sum.mean_per_dof()));
  sum.add(12.0, 10);
  sum.add(8.0, 10);
  EXPECT_EQ(sum.mean_per_dof(), 1.0);
  EXPECT_NEAR(sum.p_value(), two_sided_p_value(20, 20), 1e-15);
  Eigen::Matrix2d covariance;
  covariance << 4, 0, 0, 9;
  EXPECT_NEAR(normalised_squared(Eigen::Vector2d(2, 3), covariance), 2.0, 1e-14);
  EXPECT_THROW(normalised_squared(Eigen::Vector2d(2, 3), -covariance), NumericalError);
}

TEST(Interval, NormalAndLogNormal) {
  const Interval normal = normal_interval(3.0, 4.0);
  EXPECT_EQ(normal.std, 2.0);
  EXPECT_NEAR(normal_cdf((normal.upper95 - 3.0) / 2.0) - normal_cdf((normal.lower95 - 3.0) / 2.0), 0.95, 1e-12);

  const double m = std::log(3e4), s = 0.4;
  const Interval log_normal = log_normal_interval(m, s * s);
  const Eigen::ArrayXd draws = (m + s * normal_rows(400000, 5).array()).exp();
  EXPECT_NEAR(log_normal.mean, draws.mean(), 0.003 * log_normal.mean);
  EXPECT_NEAR(log_normal.std, std::sqrt((draws - draws.mean()).square().mean()), 0.02 * log_normal.std);
  EXPECT_NEAR((draws > log_normal.lower95 && draws < log_normal.upper95).cast<double>().mean(), 0.95, 0.002);
  EXPECT_NEAR(log_normal_interval(m, 1e-20).std, 3e4 * 1e-10, 1e-12);  // no cancellation for a narrow posterior
}

TEST(RobustWeights, FewGrossOutliersLoseTheirPull) {
  Eigen::VectorXd rows = normal_rows(300, 3);
  rows[10] = 100.0;
  rows[20] = -1000.0;
  const Eigen::VectorXd weights = robust_weights(rows);
  EXPECT_LT(weights[10], 2e-3);
  EXPECT_LT(weights[20], 2e-5);
  EXPECT_LT(weights[20] * 1000.0, weights[10] * 100.0);  // the pull falls
  EXPECT_GE((weights.array() == 1.0).count(), 296);
}

TEST(RobustWeights, CleanNoiseKeepsItsWeight) {
  EXPECT_GT(robust_weights(normal_rows(30000, 4)).mean(), 0.9997);
  EXPECT_GT(robust_weights(normal_rows(30000, 4), 3).mean(), 0.9999);
}

TEST(RobustWeights, AMisfitOfTheWholeBodyStaysVisible) {
  const Eigen::VectorXd noise = normal_rows(300, 5);
  const Eigen::VectorXd wave = Eigen::VectorXd::LinSpaced(300, 0, 3).array().sin() * 30.0;
  EXPECT_GT(robust_weights(noise + wave).minCoeff(), 0.99);
  EXPECT_GT(robust_weights(noise.array() + 20.0).minCoeff(), 0.99);
}

TEST(RobustWeights, PointsShareOneWeightAndMissingRowsKeepTheirs) {
  Eigen::VectorXd rows = normal_rows(90, 6);
  rows[31] = 80.0;
  rows[60] = std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd weights = robust_weights(rows, 3);
  EXPECT_LT(weights[31], 0.02);
  EXPECT_EQ(weights[30], weights[31]);
  EXPECT_EQ(weights[32], weights[31]);
  EXPECT_EQ(weights[60], 1.0);
  EXPECT_EQ(robust_weights(Eigen::VectorXd()).size(), 0);
  EXPECT_THROW(robust_weights(rows, 7), std::invalid_argument);
}

}  // namespace
}  // namespace tissue_stiffness
