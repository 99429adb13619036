#include "estimation/difference_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tissue_stiffness {
namespace {

constexpr double kStd = 1.5;

// A swing of ten times the noise, at uneven times.
Eigen::VectorXd swing(double time) {
  return 15.0 * Eigen::Vector3d(std::sin(2.0 * time), std::cos(time), 0.0);
}

DifferenceNoise noise_of_swing(int outlier = -1) {
  std::mt19937 random(3);
  std::normal_distribution<double> error(0.0, kStd);
  DifferenceNoise noise;
  for (int k = 0; k < 400; ++k) {
    const double time = 0.02 * k + (k % 3 == 0 ? 0.008 : 0.0);
    Eigen::VectorXd value = swing(time);
    for (Eigen::Index i = 0; i < 3; ++i) value[i] += error(random);
    if (k == outlier) value[1] += 200.0;
    noise.add(time, value);
  }
  return noise;
}

TEST(DifferenceNoise, IsThatOfASmoothSignal) {
  EXPECT_NEAR(noise_of_swing().variance(), kStd * kStd, 0.15 * kStd * kStd);
}

TEST(DifferenceNoise, IsNotMadeByAnOutlier) {
  const DifferenceNoise noise = noise_of_swing(200);
  const Eigen::VectorXd weights = noise.weights();
  EXPECT_NEAR(noise.variance(), kStd * kStd, 0.25 * kStd * kStd);
  ASSERT_EQ(weights.size(), 400);
  EXPECT_LT(weights[200], 0.01);
  EXPECT_GT(weights[198], 0.9);
  EXPECT_EQ(weights[0], 1.0);
}

TEST(DifferenceNoise, LeavesOutWhatIsOutOfOrder) {
  DifferenceNoise noise;
  noise.add(0.0, Eigen::Vector3d::Zero());
  noise.add(1.0, Eigen::Vector3d::Zero());
  EXPECT_TRUE(std::isinf(noise.variance()));
  noise.add(0.5, Eigen::Vector3d::Constant(100.0));
  noise.add(2.0, Eigen::Vector3d::Constant(NAN));
  EXPECT_TRUE(std::isinf(noise.variance()));
  noise.add(2.0, Eigen::Vector3d::Constant(0.6));
  EXPECT_NEAR(noise.variance(), 0.3 * 0.3 / 1.5, 1e-12);
  EXPECT_EQ(noise.weights().size(), 5);
}

}  // namespace
}  // namespace tissue_stiffness
