// Scans of a cost with many local minima.
#include "fit/coordinate_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 0.37;  // of the first coordinate, which tunes the oscillation
constexpr int kPoints = 12;
constexpr double kReach = 2.5;

// Returns the squared error of an oscillation over three seconds. The second coordinate says nothing.
double ringing_cost(const Eigen::VectorXd& w) {
  double out = 0.0;
  for (int k = 0; k < 90; ++k) {
    const double t = k / 30.0, rate = 2.0 * M_PI;
    out += std::pow(std::cos(rate * std::exp(0.5 * w[0]) * t) - std::cos(rate * std::exp(0.5 * kTruth) * t), 2);
  }
  return out;
}

TEST(CoordinateScan, FindsTheMinimumBetweenItsPoints) {
  const Eigen::Vector2d start(-1.5, 0.2), std(1.0, 0.0);
  const ScanResult coarse = scan_coordinates(ringing_cost, start, Eigen::Vector2d::Zero(), std, kPoints, kReach);
  const double step = kReach / kPoints;
  ASSERT_TRUE(coarse.moved);
  EXPECT_NEAR(coarse.best[0], kTruth, step);
  const ScanResult refined = refine_coordinates(ringing_cost, coarse.best, coarse.lowest, step * std);
  EXPECT_TRUE(refined.moved);
  EXPECT_NEAR(refined.best[0], kTruth, step / 8.0);
  EXPECT_LT(refined.lowest, 0.1 * coarse.lowest);
  EXPECT_DOUBLE_EQ(refined.lowest, ringing_cost(refined.best));
  EXPECT_DOUBLE_EQ(refined.step[0], step / 8.0);
  EXPECT_EQ(refined.best[1], 0.2);
}

TEST(CoordinateScan, StaysAtAMinimum) {
  const Eigen::Vector2d truth(kTruth, 0.0);
  const ScanResult refined = refine_coordinates(ringing_cost, truth, ringing_cost(truth), Eigen::Vector2d(0.2, 0.2));
  EXPECT_FALSE(refined.moved);
  EXPECT_EQ(refined.best, truth);
}

}  // namespace
}  // namespace tissue_stiffness
