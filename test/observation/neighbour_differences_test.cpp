// Differences between neighbours keep noise and lose what is smooth.
#include "observation/neighbour_differences.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tissue_stiffness {
namespace {

/// Vectors are measured at points of a curved surface.
class NeighbourDifferences : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < kPoints; ++i) {
      const double x = unit(), y = unit();
      places_.middleCols<3>(3 * i) = Eigen::Vector3d(x, y, 0.3 * std::sin(2.0 * x)).replicate<1, 3>();
    }
    for (Eigen::Index r = 0; r < sigma_.size(); ++r) sigma_[r] = 0.001 * (1.0 + unit());
  }
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  // In stated standard deviations.
  Eigen::VectorXd noise() {
    Eigen::VectorXd out(sigma_.size());
    for (Eigen::Index r = 0; r < out.size(); ++r) out[r] = std::normal_distribution<double>()(random_);
    return out;
  }
  Eigen::VectorXd smooth(double bent) const {
    Eigen::VectorXd out(sigma_.size());
    for (Eigen::Index r = 0; r < out.size(); ++r) {
      const Eigen::Vector3d x = places_.col(r);
      const double component = static_cast<double>(r % 3);
      out[r] = 0.01 * (1.0 + component + x.dot(Eigen::Vector3d(1.0, -2.0, component)) + bent * x[0] * x[0]) / sigma_[r];
    }
    return out;
  }
  static double mean_square(const Eigen::VectorXd& differences) {
    return differences.squaredNorm() / static_cast<double>((differences.array() != 0.0).count());
  }

  static constexpr int kPoints = 100;
  std::mt19937 random_{7};
  Eigen::Matrix3Xd places_{3, 3 * kPoints};
  Eigen::VectorXd sigma_{3 * kPoints}, used_ = Eigen::VectorXd::Ones(3 * kPoints);
};

TEST_F(NeighbourDifferences, HaveTheVarianceOfTheNoise) {
  const SparseMatrix differences = neighbour_differences(places_, sigma_, used_);
  ASSERT_EQ(differences.rows(), 3 * kPoints);
  double sum = 0.0;
  for (int k = 0; k < 50; ++k) sum += mean_square(differences * noise());
  EXPECT_NEAR(sum / 50.0, 1.0, 0.03);
  const SparseMatrix columns = differences.transpose();
  for (Eigen::Index k = 0; k < columns.cols(); ++k) EXPECT_NEAR(columns.col(k).squaredNorm(), 1.0, 1e-12);
}

TEST_F(NeighbourDifferences, LoseWhatIsSmooth) {
  const SparseMatrix differences = neighbour_differences(places_, sigma_, used_);
  EXPECT_LT(mean_square(differences * smooth(0.0)), 1e-16 * mean_square(smooth(0.0)));
  EXPECT_LT(mean_square(differences * smooth(5.0)), 1e-3 * mean_square(smooth(5.0)));
}

TEST_F(NeighbourDifferences, LeaveOutWhatIsNotUsed) {
  used_.segment<3>(30).setZero();
  places_.middleCols<3>(60).setConstant(std::numeric_limits<double>::quiet_NaN());
  const SparseMatrix differences = neighbour_differences(places_, sigma_, used_);
  Eigen::VectorXd wrong = Eigen::VectorXd::Zero(3 * kPoints);
  wrong.segment<3>(30).setConstant(1e6);
  wrong.segment<3>(60).setConstant(1e6);
  EXPECT_EQ((differences * wrong).norm(), 0.0);
  EXPECT_NEAR(mean_square(differences * noise()), 1.0, 0.3);
}

TEST_F(NeighbourDifferences, NeedSixPointsAndTakeAFewOfMany) {
  EXPECT_EQ(neighbour_differences(places_.leftCols(15), sigma_.head(15), used_.head(15)).rows(), 0);
  EXPECT_EQ(neighbour_differences(places_.leftCols(18), sigma_.head(18), used_.head(18)).rows(), 18);
  Eigen::Matrix3Xd cloud = Eigen::Matrix3Xd::Random(3, 1000);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(1000);
  EXPECT_EQ(neighbour_differences(cloud, ones, ones).rows(), 128);
}

// Named points keep their weights while the same ones are seen.
TEST_F(NeighbourDifferences, KeepTheirWeightsOnTheSameNodes) {
  Eigen::VectorXi nodes = Eigen::VectorXi::LinSpaced(3 * kPoints, 0, 3 * kPoints - 1);
  NeighbourWeights known;
  const SparseMatrix first = known.of(nodes, places_, used_);
  EXPECT_EQ((first - neighbour_weights(places_, used_)).norm(), 0.0);
  const Eigen::Matrix3Xd moved = places_.array().square();
  EXPECT_EQ((known.of(nodes, moved, used_) - first).norm(), 0.0);
  used_.head<3>().setZero();
  EXPECT_EQ((known.of(nodes, moved, used_) - neighbour_weights(moved, used_)).norm(), 0.0);
  nodes.reverseInPlace();
  EXPECT_EQ((known.of(nodes, places_, used_) - neighbour_weights(places_, used_)).norm(), 0.0);
}

}  // namespace
}  // namespace tissue_stiffness
