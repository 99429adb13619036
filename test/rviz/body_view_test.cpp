#include "rviz/body_view.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr double kAngle = 0.785398;

/// The corners of a box.
Eigen::Matrix3Xd box(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Eigen::Matrix3Xd out(3, 8);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    out.col(i) = centre + sign.cwiseProduct(size);
  }
  return out;
}

/// How far from the middle of the picture (0) to its edge (1) the farthest point is seen; infinite for one behind the
/// camera.
double farthest_in_picture(const Eigen::Matrix3Xd& points, const BodyView& view, double aspect, double yaw, double pitch) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  const double edge = std::tan(0.5 * kAngle);
  double out = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d seen = turn * (points.col(i) - view.centre);  // x to the right, y forwards
    const double depth = seen.y() + view.distance;
    if (depth <= 0.0) return std::numeric_limits<double>::infinity();
    out = std::max({out, std::abs(seen.x()) / depth / (edge * aspect), std::abs(seen.z()) / depth / edge});
  }
  return out;
}

TEST(BodyView, HoldsBodiesOfAnySizeAndPlaceFromEveryDirection) {
  for (const double size : {1e-3, 0.08, 2.0, 50.0}) {
    for (const Eigen::Vector3d& offset : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, -300, 40)}) {
      for (const double aspect : {0.4, 1.0, 2.5}) {
        const Eigen::Matrix3Xd points = box(offset, {size, 0.2 * size, 0.5 * size});
        const auto view = view_of_body(points, kAngle, aspect);
        ASSERT_TRUE(view);
        EXPECT_LT((view->centre - offset).norm(), 1e-9);
        double largest = 0.0;
        for (int i = 0; i < 64; ++i) {
          largest = std::max(largest, farthest_in_picture(points, *view, aspect, 0.4 * i, 0.1 * (i % 16)));
        }
        EXPECT_LT(largest, 1.0) << size << " m, aspect " << aspect;
        EXPECT_GT(largest, 0.5) << "the body is small in the picture";
      }
    }
  }
}

TEST(BodyView, DoesNotCountPointsThatAreNotFinite) {
  Eigen::Matrix3Xd points = box({1, 2, 3}, {0.1, 0.1, 0.1});
  const auto whole = view_of_body(points, kAngle, 1.0);
  points.conservativeResize(3, 9);
  points.col(8) << std::nan(""), 100.0, 100.0;
  const auto with_broken = view_of_body(points, kAngle, 1.0);
  ASSERT_TRUE(whole && with_broken);
  EXPECT_EQ(whole->centre, with_broken->centre);
  EXPECT_EQ(whole->distance, with_broken->distance);
}

TEST(BodyView, RefusesBodiesWithoutExtentAndCamerasThatSeeNothing) {
  const Eigen::Matrix3Xd points = box({0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(view_of_body(Eigen::Matrix3Xd(3, 0), kAngle, 1.0));
  EXPECT_FALSE(view_of_body(points.leftCols(1), kAngle, 1.0));
  EXPECT_FALSE(view_of_body(Eigen::Matrix3Xd::Constant(3, 4, std::nan("")), kAngle, 1.0));
  for (const double angle : {0.0, -1.0, 3.2, std::nan("")}) EXPECT_FALSE(view_of_body(points, angle, 1.0)) << angle;
  for (const double aspect : {0.0, -1.0, std::nan("")}) EXPECT_FALSE(view_of_body(points, kAngle, aspect)) << aspect;
}

}  // namespace
}  // namespace tissue_stiffness
