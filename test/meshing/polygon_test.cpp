#include "meshing/polygon.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tissue_stiffness {
namespace {

double doubled_area(const Eigen::Matrix2Xd& points, const Eigen::Vector3i& t) {
  const Eigen::Vector2d a = points.col(t[1]) - points.col(t[0]), b = points.col(t[2]) - points.col(t[0]);
  return a.x() * b.y() - a.y() * b.x();
}

// Rounding puts a point of a side now inside, now outside of the triangle.
TEST(CutEars, PointsOnASideGetTrianglesWithArea) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-0.1, 0.1), along(0.3, 0.7);
  for (int trial = 0; trial < 500; ++trial) {
    Eigen::Matrix2Xd points(2, 5);
    for (const int corner : {0, 2, 4}) points.col(corner) << anywhere(random), anywhere(random);
    if (doubled_area(points, {0, 2, 4}) < 0.0) points.col(2).swap(points.col(4));
    const double whole = doubled_area(points, {0, 2, 4});
    if (whole < 1e-3) continue;  // a needle
    const double s = along(random), t = along(random);
    points.col(1) = (1.0 - s) * points.col(0) + s * points.col(2);
    points.col(3) = (1.0 - t) * points.col(2) + t * points.col(4);
    double sum = 0.0;
    for (const Eigen::Vector3i& ear : cut_ears(points, {{0, 1, 2, 3, 4}})) {
      EXPECT_GT(doubled_area(points, ear), 0.05 * whole) << "trial " << trial;
      sum += doubled_area(points, ear);
    }
    EXPECT_NEAR(sum, whole, 1e-12);
  }
}

}  // namespace
}  // namespace tissue_stiffness
