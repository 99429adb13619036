// Intervals of a straight line's slope, whose errors are drawn again and again.
#include "filter/score_batches.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "filter/posterior_linearization_filter.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 400, kRows = 10, kSeeds = 300;

struct Covered {
  double plain = 0.0, robust = 0.0;
};

// y = 2 x_k + e, x_k a slow wave; `memory`: of the errors, from frame to frame (all rows of a frame share it).
Covered coverage(double memory) {
  Covered out;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    PosteriorLinearizationFilter filter(Eigen::VectorXd::Constant(1, 2.0), Eigen::MatrixXd::Constant(1, 1, 100.0));
    double shared = normal(engine);
    for (int k = 0; k < kFrames; ++k) {
      shared = memory * shared + std::sqrt(1.0 - memory * memory) * normal(engine);
      const double x = 1.5 + std::sin(0.05 * k);
      const Eigen::VectorXd y = Eigen::VectorXd::NullaryExpr(
          kRows, [&](auto) { return 2.0 * x + (memory > 0.0 ? 0.5 * shared : 0.0) + normal(engine); });
      const Eigen::VectorXd one = Eigen::VectorXd::Ones(kRows);
      filter.update(y, x * one * filter.sigma_points(), one, one);
    }
    const double off = std::abs(filter.mean()[0] - 2.0);
    out.plain += off < 1.96 * std::sqrt(filter.covariance()(0, 0)) ? 1.0 / kSeeds : 0.0;
    out.robust += off < 1.96 * std::sqrt(filter.robust_covariance()(0, 0)) ? 1.0 / kSeeds : 0.0;
  }
  return out;
}

TEST(ScoreBatches, LeaveWhiteNoiseAlone) {
  const Covered covered = coverage(0.0);
  EXPECT_NEAR(covered.plain, 0.95, 0.035);
  EXPECT_NEAR(covered.robust, covered.plain, 0.02);
}

TEST(ScoreBatches, WidenForErrorsWithAMemory) {
  const Covered covered = coverage(0.8);  // a fifth of a batch's length
  EXPECT_LT(covered.plain, 0.6);
  EXPECT_NEAR(covered.robust, 0.90, 0.06) << "batches that short still know of each other";
}

TEST(ScoreBatches, WidenOnlyWhereErrorsAgree) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  ScoreBatches batches;
  for (int k = 0; k < 1000; ++k) {
    const double wave = 5.0 * std::sin(0.05 * k);  // of the first parameter's errors
    batches.add(Eigen::Matrix2d::Identity(), Eigen::Vector2d(wave + normal(engine), normal(engine)));
  }
  EXPECT_GE(batches.count(), 16);
  EXPECT_LT(batches.count(), 32);
  const Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() / 1000.0;
  const Eigen::MatrixXd wide = batches.widened(covariance, batches.variance(Eigen::Vector2d::Zero()));
  EXPECT_GT(wide(0, 0), 10.0 * covariance(0, 0));
  EXPECT_NEAR(wide(1, 1) / covariance(1, 1), 1.0, 0.3);
}

// Of scores 1, 2, 3, ... of one parameter, pairs of frames become one batch when 32 are full.
TEST(ScoreBatches, JoinNeighboursWhenThereAreMany) {
  ScoreBatches batches;
  double sum = 0.0;
  for (int k = 0; k < 40; ++k) batches.add(Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Constant(1, k + 1.0));
  for (int k = 0; k < 20; ++k) sum += std::pow(4.0 * k + 3.0 - 2.0 * 0.5, 2);
  EXPECT_EQ(batches.count(), 20);
  EXPECT_NEAR(batches.variance(Eigen::VectorXd::Constant(1, 0.5))(0, 0), 20.0 / 19.0 * sum, 1e-9 * sum);
}

// Directions are widened each by its own share, in units of the covariance, which need not be a multiple of one.
TEST(ScoreBatches, WidenInUnitsOfTheCovariance) {
  ScoreBatches batches;
  for (int k = 0; k < 20; ++k) batches.add(Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero());
  const Eigen::Matrix2d covariance = (Eigen::Matrix2d() << 4.0, 1.0, 1.0, 2.0).finished();
  const Eigen::Matrix2d inverse = covariance.inverse();
  EXPECT_TRUE(batches.widened(covariance, inverse).isApprox(covariance, 1e-12)) << "as large as noise makes it";
  EXPECT_TRUE(batches.widened(covariance, 9.0 * inverse).isApprox(9.0 * covariance, 1e-12));
  EXPECT_TRUE(batches.widened(covariance, 0.1 * inverse).isApprox(covariance, 1e-12)) << "never narrower";
}

TEST(ScoreBatches, FewFramesSayNothing) {
  ScoreBatches batches;
  for (int k = 0; k < 10; ++k) batches.add(Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Constant(1, 100.0));
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(1, 1, 0.1);
  EXPECT_EQ(batches.widened(covariance, batches.variance(Eigen::VectorXd::Zero(1))), covariance);
}

}  // namespace
}  // namespace tissue_stiffness
