#include "rviz/live_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

LiveCurve::Point point(double time, double value, double half_band = 0.0) {
  return {time, value, value - half_band, value + half_band};
}

TEST(LiveCurve, KeepsPointsInOrderAndStepsAtOneTime) {
  LiveCurve curve;
  curve.add(point(1.0, 18.0));
  curve.add(point(2.0, 18.5));
  curve.add(point(2.0, 12.0));
  ASSERT_EQ(curve.points().size(), 3U);
  EXPECT_EQ(curve.points()[2].value, 12.0);
  EXPECT_EQ(curve.times().low, 1.0);
  EXPECT_EQ(curve.times().high, 2.0);
}

TEST(LiveCurve, AnEarlierTimeBeginsAnew) {
  LiveCurve curve;
  curve.add(point(5.0, 1.0));
  curve.add(point(6.0, 2.0));
  curve.mark("+ gravity");
  curve.add(point(0.1, 3.0));
  ASSERT_EQ(curve.points().size(), 1U);
  EXPECT_EQ(curve.points()[0].value, 3.0);
  EXPECT_TRUE(curve.events().empty());
}

TEST(LiveCurve, LeavesOutWhatIsNotFinite) {
  LiveCurve curve;
  curve.add(point(1.0, kNan));
  curve.add(point(kNan, 1.0));
  EXPECT_TRUE(curve.points().empty());
}

TEST(LiveCurve, AFullOneKeepsTheWholeRunAndTheNewestPoint) {
  LiveCurve curve(64);
  for (int i = 0; i <= 100000; ++i) {
    curve.add(point(0.01 * i, i));
    ASSERT_EQ(curve.points().back().value, i);
  }
  EXPECT_LT(curve.points().size(), 66U);
  EXPECT_GT(curve.points().size(), 30U);
  EXPECT_EQ(curve.points().front().value, 0.0);
  double longest = 0.0;
  for (std::size_t i = 1; i < curve.points().size(); ++i) {
    longest = std::max(longest, curve.points()[i].value - curve.points()[i - 1].value);
    ASSERT_GT(curve.points()[i].value, curve.points()[i - 1].value);
  }
  EXPECT_LT(longest, 100000.0 / 25.0);
}

TEST(LiveCurve, TheRangeShowsAllValuesAndDoesNotLetAWideBandFlattenThem) {
  LiveCurve curve;
  curve.add({0.0, 24.0, 3.0, 190.0});
  curve.add({1.0, 12.0, 11.5, 12.5});
  const LiveCurve::Range range = curve.values();
  EXPECT_LE(range.low, 11.5);
  EXPECT_GE(range.high, 24.0);
  EXPECT_LT(range.high, 40.0);
}

TEST(LiveCurve, RangesAreNeverEmpty) {
  LiveCurve curve;
  EXPECT_LT(curve.values().low, curve.values().high);
  EXPECT_LT(curve.times().low, curve.times().high);
  curve.add(point(1.0, 0.0));
  EXPECT_LT(curve.values().low, curve.values().high);
  EXPECT_LT(curve.times().low, curve.times().high);
}

}  // namespace
}  // namespace tissue_stiffness
