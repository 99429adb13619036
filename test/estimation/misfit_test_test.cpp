// The posterior predictive test of a residual is checked on noise whose structure is known.
#include "estimation/misfit_test.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 200, kRows = 100, kModes = 4;

// Tests white noise of these levels along the first rows, which the modes see, and across them.
MisfitTest test_of(double along, double across) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd shapes = Eigen::MatrixXd::Identity(kRows, kModes);
  MisfitTest out;
  for (int k = 0; k < kFrames; ++k) {
    Eigen::VectorXd residual(kRows);
    for (int i = 0; i < kRows; ++i) residual[i] = std::sqrt(i < kModes ? along : across) * normal(random);
    out.add(residual, Eigen::VectorXd::Ones(kRows), shapes);
  }
  return out;
}

TEST(MisfitTest, TakesNoiseForNoiseWhateverItsLevel) {
  for (const double level : {1.0, 4.0}) {
    const MisfitTest test = test_of(level, level);
    EXPECT_NEAR(test.noise_level(), level, 0.1 * level);
    EXPECT_TRUE(test.passes());
    EXPECT_EQ(test.discrepancy(), 0.0);
  }
  EXPECT_FALSE(test_of(36.0, 36.0).passes()) << "six times the stated noise";
}

TEST(MisfitTest, SeesWhatTheModesHaveBeyondTheRest) {
  const MisfitTest test = test_of(9.0, 1.0);
  EXPECT_NEAR(test.excess(), 8.0, 1.5);
  EXPECT_GT(test.z(), 20.0);
  EXPECT_NEAR(test.discrepancy(), 8.0 * kModes / kRows, 0.06);
  MisfitTest allowed = test;
  allowed.set_numerics(9.0 * kModes / kRows);
  EXPECT_TRUE(allowed.passes());
}

TEST(MisfitTest, ToleratesNothingWhereAllOfTheNumericsIsKnown) {
  MisfitTest test = test_of(1.7, 1.0);
  EXPECT_TRUE(test.passes());
  test.set_numerics(0.0);
  EXPECT_TRUE(test.passes()) << "the estimator knows a part of the numerics";
  test.tolerate_no_more();
  EXPECT_FALSE(test.passes());
  EXPECT_NEAR(test.z(), test.excess() / test.deviation(), 1e-12);
  test.set_numerics(0.7 * kModes / kRows);
  EXPECT_TRUE(test.passes());
}

// Noise of the variance 1.7 exceeds the others' by an error of the variance 0.7. The error explains the excess, and its own
// variance widens the test.
TEST(MisfitTest, TakesOffWhatAnErrorExplains) {
  MisfitTest test = test_of(1.7, 1.0);
  test.tolerate_no_more();
  const double excess = test.excess(), deviation = test.deviation(), dof = test.structured_dof();
  test.set_explained(0.7 * dof, 9.0 * deviation * deviation * dof * dof);
  EXPECT_NEAR(test.excess(), excess - 0.7, 1e-9);
  EXPECT_NEAR(test.deviation(), std::sqrt(10.0) * deviation, 1e-9);
  EXPECT_TRUE(test.passes());
}

// Noise that another model has shown not to be there is a misfit, both where the modes see it and where they do not.
TEST(MisfitTest, KnowsTheNoiseFromAnotherModel) {
  MisfitTest test = test_of(1.0, 4.0);
  EXPECT_TRUE(test.passes());
  test.set_noise(1.0);
  EXPECT_EQ(test.noise_level(), 1.0);
  EXPECT_GT(test.z(), 20.0);
  EXPECT_NEAR(test.discrepancy(), 3.0 * (kRows - kModes) / kRows, 0.3);
  test.set_numerics(0.0, 4.0);
  EXPECT_TRUE(test.passes());
  MisfitTest little = test_of(1.0, 1.5);
  little.set_noise(1.0);
  EXPECT_TRUE(little.passes()) << "less than one noise variance";
  EXPECT_EQ(little.discrepancy(), 0.0);
  MisfitTest louder = test_of(1.0, 1.0);
  louder.set_noise(4.0);
  EXPECT_NEAR(louder.noise_level(), 1.0, 0.1) << "its own is less";
}

// What is missed may lie across the modes as well. Differences between neighbours do not hold it, so it is no noise.
TEST(MisfitTest, KnowsTheNoiseFromDifferencesBetweenNeighbours) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto noise = [&](double level) {
    Eigen::VectorXd out(kRows);
    for (int i = 0; i < kRows; ++i) out[i] = level * normal(random);
    return out;
  };
  MisfitTest missing = test_of(1.0, 4.0), noisy = test_of(4.0, 4.0);
  Eigen::VectorXd last = noise(1.0);
  for (int k = 0; k < kFrames; ++k) {
    last = 0.8 * last + 0.6 * noise(1.0);
    missing.add_differences(last);
    noisy.add_differences(noise(2.0));
  }
  EXPECT_NEAR(missing.noise_level(), 1.0, 0.05);
  EXPECT_NEAR(missing.lag1_autocorrelation(), 0.8, 0.05);
  EXPECT_GT(missing.z(), 20.0);
  EXPECT_NEAR(missing.discrepancy(), 3.0 * (kRows - kModes) / kRows, 0.3);
  EXPECT_NEAR(noisy.noise_level(), 4.0, 0.2);
  EXPECT_LT(noisy.lag1_autocorrelation(), 0.05);
  EXPECT_TRUE(noisy.passes());
}

// An outline is off along a whole side: neighbours share most of the noise that is stated.
TEST(MisfitTest, ToleratesNoiseThatNeighboursShare) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto with_differences = [&](double along, double level) {
    MisfitTest out = test_of(along, 0.3);
    out.tolerate_no_more();
    for (int k = 0; k < kFrames; ++k) {
      Eigen::VectorXd differences(kRows);
      for (int i = 0; i < kRows; ++i) differences[i] = std::sqrt(level) * normal(random);
      out.add_differences(differences);
    }
    return out;
  };
  const MisfitTest shared = with_differences(1.7, 0.1), own = with_differences(1.7, 1.0), more = with_differences(2.5, 0.1);
  EXPECT_NEAR(shared.shared_noise(), 0.9, 0.02);
  EXPECT_NEAR(shared.z(), (shared.excess() - shared.shared_noise()) / shared.deviation(), 1e-12);
  EXPECT_TRUE(shared.passes());
  EXPECT_LT(own.shared_noise(), 0.02);
  EXPECT_FALSE(own.passes()) << "neighbours show all of the stated noise";
  EXPECT_FALSE(more.passes()) << "more than the stated noise";
  EXPECT_EQ(with_differences(1.7, 4.0).shared_noise(), 0.0);
}

// A force has no rows across the modes, which would make noise of whatever it misses.
TEST(MisfitTest, CountsAllThatAForceMisses) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(3, 2);
  const std::vector<Eigen::Index> rows{0, 1, 2};
  MisfitTest blind, seeing, right;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 40; ++k) {
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random)),
        ones = Eigen::Vector3d::Ones(), missed = noise + 3.0 * std::sin(0.2 * k) * ones;
    blind.add(missed, ones, none);
    seeing.add(missed, ones, with_unit_columns(none, rows));
    right.add(noise, ones, with_unit_columns(none, rows));
  }
  EXPECT_TRUE(blind.passes());
  EXPECT_FALSE(seeing.passes());
  EXPECT_GT(seeing.discrepancy(), 1.0);
  EXPECT_TRUE(right.passes());
}

}  // namespace
}  // namespace tissue_stiffness
