#include "types/repeated_observation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

Observation cloud() {
  Observation out;
  out.time = 1.0;
  out.points = Eigen::Matrix3Xd::Constant(3, 2, 0.5);
  out.ids = Eigen::Vector2i(3, 4);
  return out;
}

Observation outline(double u) {
  Observation out;
  out.kind = ObservationKind::contour;
  auto contour = std::make_shared<Contour>();
  contour->points = Eigen::Matrix2Xd::Constant(2, 3, u);
  out.contour = contour;
  return out;
}

bool is_repeated(const Observation& observation, std::vector<Observation> others) {
  others.push_back(observation);
  Frame frame{1.0, others};
  const bool repeats = holds_repeats(frame);
  EXPECT_EQ(leave_out_repeats(frame), repeats ? 1 : 0);
  EXPECT_EQ(frame.observations.size(), others.size() - (repeats ? 1 : 0));
  return repeats;
}

TEST(RepeatedObservation, IsEqualInAllThatWasMeasured) {
  EXPECT_FALSE(is_repeated(cloud(), {}));
  EXPECT_TRUE(is_repeated(cloud(), {outline(1.0), cloud()}));
  EXPECT_TRUE(is_repeated(outline(1.0), {outline(2.0), outline(1.0)}));
  EXPECT_FALSE(is_repeated(outline(1.0), {outline(2.0), cloud()}));
  Observation holed = cloud();
  holed.points(1, 0) = std::nan("");  // a point that the tracker has lost
  EXPECT_TRUE(is_repeated(holed, {holed}));
  EXPECT_FALSE(is_repeated(cloud(), {holed}));
}

TEST(RepeatedObservation, TheFirstOfThemStays) {
  Frame frame{1.0, {cloud(), outline(1.0), cloud(), cloud(), outline(2.0), outline(1.0)}};
  EXPECT_EQ(leave_out_repeats(frame), 3);
  ASSERT_EQ(frame.observations.size(), 3U);
  EXPECT_EQ(frame.observations[1].contour->points(0, 0), 1.0);
  EXPECT_EQ(frame.observations[2].contour->points(0, 0), 2.0);
}

// A tracker may send the points of one instant in several messages, and two sensors may agree.
TEST(RepeatedObservation, IsNotOneThatDiffersAnywhere) {
  Observation other = cloud();
  other.source = 1;
  EXPECT_FALSE(is_repeated(cloud(), {other}));
  other = cloud();
  other.ids[1] = 5;
  EXPECT_FALSE(is_repeated(cloud(), {other}));
  other = cloud();
  other.points(2, 1) += 1e-9;
  EXPECT_FALSE(is_repeated(cloud(), {other}));
  other = cloud();
  other.points.conservativeResize(3, 1);
  other.ids.conservativeResize(1);
  EXPECT_FALSE(is_repeated(cloud(), {other}));
}

}  // namespace
}  // namespace tissue_stiffness
