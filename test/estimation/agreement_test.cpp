#include "estimation/agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tissue_stiffness {
namespace {

// Rows of two recordings: w[0] and one error of the rig act on both, nobody sees w[1].
struct Rig {
  Eigen::MatrixXd slopes;  // rows x [w; eta]
  Eigen::VectorXd rows(const Eigen::Vector3d& z, std::mt19937& engine) const {
    std::normal_distribution<double> normal;
    return slopes * z + Eigen::VectorXd::NullaryExpr(slopes.rows(), [&](Eigen::Index) { return normal(engine); });
  }
  LinearFit fit(const Eigen::VectorXd& y) const { return {slopes.transpose() * slopes, slopes.transpose() * y}; }
};

Rig rig(double first, double second) {
  Eigen::MatrixXd slopes(2, 3);
  slopes << first, 0.0, second, 0.5 * first, 0.0, -second;
  return {slopes};
}

const NormalPrior kPrior{Eigen::Vector2d(0.3, 0.0), Eigen::Vector2d(2.0, 1.0), Eigen::VectorXd::Ones(1)};

double mean_chi2(double apart, double& share_failed) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  const Rig one = rig(4.0, 6.0), two = rig(7.0, 5.0);
  constexpr int kDraws = 4000;
  double sum = 0.0, failed = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    const double w = 0.3 + 2.0 * normal(engine), error = normal(engine);
    const Agreement found =
        agreement(one.fit(one.rows({w + apart, 0.0, error}, engine)), two.fit(two.rows({w, 0.0, error}, engine)), kPrior);
    EXPECT_EQ(found.dof, 1);
    sum += found.chi2;
    failed += found.passes() ? 0.0 : 1.0;
  }
  share_failed = failed / kDraws;
  return sum / kDraws;
}

TEST(Agreement, IsChiSquaredWhereTheRecordingsAreOfOneBody) {
  double failed = 0.0;
  EXPECT_NEAR(mean_chi2(0.0, failed), 1.0, 0.1);
  EXPECT_LT(failed, 0.005);  // 3 standard deviations, one-sided: 0.00135
}

TEST(Agreement, FailsWhereTheyAreNot) {
  double failed = 0.0;
  EXPECT_GT(mean_chi2(2.0, failed), 20.0);
  EXPECT_GT(failed, 0.9);
}

// An error that both share does not set them apart, however much it moves both.
TEST(Agreement, ForgivesWhatTheRigDoesToBoth) {
  Eigen::MatrixXd slope(1, 3);
  slope << 10.0, 0.0, 10.0;  // w and the error cannot be told apart
  const Rig same{slope};
  Eigen::VectorXd y(1), z(1);
  y << 20.0;
  z << 20.0;
  const Agreement found = agreement(same.fit(y), same.fit(z), kPrior);
  EXPECT_EQ(found.dof, 1);
  EXPECT_NEAR(found.chi2, 0.0, 1e-9);
}

TEST(Agreement, OfARecordingThatTellsNothingPasses) {
  const Rig one = rig(1e-2, 0.0), two = rig(7.0, 5.0);
  const Agreement found = agreement(one.fit(Eigen::Vector2d(3.0, 3.0)), two.fit(Eigen::Vector2d(1.0, 1.0)), kPrior);
  EXPECT_EQ(found.dof, 0);
  EXPECT_TRUE(found.passes());
}

TEST(Agreement, KnowsTheQuantilesOfChiSquared) {
  EXPECT_NEAR((Agreement{9.0, 1}.z()), 2.78, 0.05);    // p = 0.0027
  EXPECT_NEAR((Agreement{18.47, 4}.z()), 3.09, 0.05);  // p = 0.001
}

}  // namespace
}  // namespace tissue_stiffness
