// The signed distance of points from a surface, against all triangles one by one.
#include "meshing/signed_distance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "meshing/closest_on_triangle.hpp"

namespace tissue_stiffness {
namespace {

// An L of 2 x 2 x 1 whose arms are 1 wide, so it has an edge at (1, 1) that looks inwards.
TriangleSurface angle_iron() {
  const std::array<std::array<double, 2>, 6> profile{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  TriangleSurface out{Eigen::Matrix3Xd(3, 12), Eigen::Matrix3Xi(3, 20)};
  int t = 0;
  for (int i = 0; i < 6; ++i) {
    const auto [x, y] = profile[static_cast<std::size_t>(i)];
    out.vertices.col(i) << x, y, 0.0;
    out.vertices.col(6 + i) << x, y, 1.0;
    const int next = (i + 1) % 6;
    out.triangles.col(t++) << i, next, 6 + next;
    out.triangles.col(t++) << i, 6 + next, 6 + i;
  }
  for (int i = 1; i < 5; ++i) {
    out.triangles.col(t++) << 0, i + 1, i;
    out.triangles.col(t++) << 6, 6 + i, 7 + i;
  }
  return out;
}

double unsigned_distance(const TriangleSurface& surface, const Eigen::Vector3d& p) {
  double out = INFINITY;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const auto corner = [&](int i) { return Eigen::Vector3d(surface.vertices.col(surface.triangles(i, t))); };
    out = std::min(out, (p - closest_on_triangle(p, corner(0), corner(1), corner(2))).norm());
  }
  return out;
}

std::vector<Eigen::Vector3d> scattered(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> around(-0.8, 2.8);
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < count; ++i) out.emplace_back(around(random), around(random), around(random) - 0.5);
  return out;
}

TEST(SignedDistance, IsThatOfTheClosestTriangleAndNegativeInside) {
  const TriangleSurface surface = angle_iron();
  const SignedDistance distance(surface);
  int inside = 0;
  for (const Eigen::Vector3d& p : scattered(5000)) {
    const bool in = winding_number(surface, p) > 0.5;
    inside += in ? 1 : 0;
    const SignedDistance::Value value = distance(p, 10.0);
    EXPECT_NEAR(value.distance, (in ? -1.0 : 1.0) * unsigned_distance(surface, p), 1e-12) << p.transpose();
    EXPECT_NEAR(value.gradient.norm(), 1.0, 1e-12);
    EXPECT_LT(unsigned_distance(surface, p - value.distance * value.gradient), 1e-12) << p.transpose();
  }
  EXPECT_GT(inside, 300);
}

TEST(SignedDistance, CurvesRoundEdgesAndVertices) {
  const SignedDistance distance(angle_iron());
  constexpr double kStep = 1e-6;
  const std::vector<Eigen::Vector3d> places = {{2.3, -0.4, 0.5}, {2.3, -0.4, 1.2}, {0.8, 0.9, 0.5}, {2.2, 0.4, 0.5}};
  for (const Eigen::Vector3d& p : places) {  // beside an edge, a vertex, the edge that looks inwards, and a face
    const Eigen::Matrix3d curvature = distance(p, 10.0).curvature;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d slope = (distance(p + step, 10.0).gradient - distance(p - step, 10.0).gradient) / (2.0 * kStep);
      EXPECT_LT((slope - curvature.col(i)).norm(), 1e-6) << p.transpose();
    }
  }
  EXPECT_TRUE(distance(places.back(), 10.0).curvature.isZero(0.0));
}

TEST(SignedDistance, OfAFarPointIsThatOfTheBox) {
  const SignedDistance distance(angle_iron());
  const Eigen::Vector3d p(3.0, 3.0, 0.5);  // the closest points are at (2, 1) and (1, 2), the box ends at (2, 2)
  EXPECT_NEAR(distance(p, 2.0).distance, std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(distance(p, 1.0).distance, std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(distance(p, 1.0).gradient.isApprox(Eigen::Vector3d(1.0, 1.0, 0.0).normalized()));
}

TEST(SignedDistance, OfAPointOnTheSurfaceHasTheSurfacesNormal) {
  const SignedDistance distance(angle_iron());
  EXPECT_TRUE(distance({0.3, 0.3, 1.0}, 1.0).gradient.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(distance({0.0, 0.0, 0.4}, 1.0).gradient.isApprox(Eigen::Vector3d(-1.0, -1.0, 0.0).normalized()));
  EXPECT_TRUE(distance({0.0, 0.0, 0.0}, 1.0).gradient.isApprox(Eigen::Vector3d(-1.0, -1.0, -1.0).normalized()));
}

}  // namespace
}  // namespace tissue_stiffness
