#include "nodes/repeated_observation.hpp"

#include <gtest/gtest.h>

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

TEST(RepeatedObservation, IsEqualInAllThatWasMeasured) {
  EXPECT_FALSE(is_repeated(cloud(), {}));
  EXPECT_TRUE(is_repeated(cloud(), {outline(1.0), cloud()}));
  EXPECT_TRUE(is_repeated(outline(1.0), {outline(2.0), outline(1.0)}));
  EXPECT_FALSE(is_repeated(outline(1.0), {outline(2.0), cloud()}));
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
