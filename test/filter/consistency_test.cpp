#include "tissue_stiffness/filter/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "tissue_stiffness/filter/interval.hpp"
#include "tissue_stiffness/filter/long_run_variance.hpp"
#include "tissue_stiffness/filter/robust_weights.hpp"
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

TEST(LongRunVariance, AutoregressiveTheory) {
  for (const double rho : {-0.5, 0.0, 0.5, 0.8}) {
    Eigen::VectorXd series = normal_rows(200000, 11);
    for (Eigen::Index i = 1; i < series.size(); ++i) series[i] += rho * series[i - 1];
    const double theory = 1.0 / ((1.0 - rho) * (1.0 - rho));  // of AR(1) with unit innovations
    const double found = long_run_variance(series, bartlett_lags(series));
    EXPECT_NEAR(found, theory, 0.1 * theory) << rho;
    const double naive = 1.0 / (1.0 - rho * rho);
    EXPECT_NEAR(long_run_variance(series, 0), naive, 0.02 * naive);
  }
}

/// The reason to have it: tests on correlated residuals reject 5 % of the time, not half of it.
TEST(LongRunVariance, KeepsTheSizeOfATest) {
  const double rho = 0.8;
  int naive = 0, corrected = 0;
  const int trials = 1000;
  for (int trial = 0; trial < trials; ++trial) {
    Eigen::VectorXd series = normal_rows(600, static_cast<unsigned>(trial));
    for (Eigen::Index i = 1; i < series.size(); ++i) series[i] += rho * series[i - 1];
    const double n = static_cast<double>(series.size());
    const auto rejects = [&](int lags) {
      return std::abs(series.sum()) > 1.96 * std::sqrt(n * long_run_variance(series, lags));
    };
    if (rejects(0)) ++naive;
    if (rejects(bartlett_lags(series))) ++corrected;
  }
  EXPECT_GT(naive, 0.35 * trials);
  EXPECT_LT(corrected, 0.10 * trials);
  EXPECT_GT(corrected, 0.02 * trials);
}

TEST(LongRunVariance, EdgeCases) {
  EXPECT_THROW(long_run_variance(Eigen::VectorXd(), 0), std::invalid_argument);
  EXPECT_THROW(long_run_variance(Eigen::VectorXd::Ones(3), -1), std::invalid_argument);
  EXPECT_EQ(bartlett_lags(Eigen::VectorXd::Zero(10)), 0);
  EXPECT_EQ(bartlett_lags(Eigen::VectorXd::Ones(1)), 0);
  EXPECT_LE(bartlett_lags(Eigen::VectorXd::Ones(5)), 4);
  const Eigen::VectorXd alternating =
      Eigen::VectorXd::LinSpaced(50, 0, 49).unaryExpr([](double t) { return std::cos(M_PI * t); });
  for (int lags = 0; lags < 50; ++lags) EXPECT_GE(long_run_variance(alternating, lags), 0.0);
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
