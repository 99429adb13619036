#include "nodes/force_view.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace tissue_stiffness {
namespace {

TEST(ForceMarker, RemovesTheOneBeforeWhereNothingIsMissing) {
  EXPECT_EQ(force_marker({}, std_msgs::Header()).action, visualization_msgs::Marker::DELETE);
}

TEST(ForceMarker, IsANeedleFromEachNodeWhenTheForceIsLargest) {
  MissingForce force;
  force.time = {0.1, 0.2};
  force.places = Eigen::Matrix3Xd::Zero(3, 3);
  force.places(0, 1) = 1.0;
  force.places(1, 2) = 2.0;
  Eigen::Matrix3Xd weak = Eigen::Matrix3Xd::Zero(3, 3), strong = weak;
  weak(0, 0) = 1.0;
  strong(2, 0) = -4.0;
  strong(2, 1) = 2.0;  // the third node: none
  force.at_nodes = {weak, strong};
  const visualization_msgs::Marker marker = force_marker(force, std_msgs::Header());
  EXPECT_EQ(marker.action, visualization_msgs::Marker::ADD);
  ASSERT_EQ(marker.points.size(), 2U * 12U);
  const double longest = 0.2 * std::sqrt(5.0);
  EXPECT_NEAR(marker.points[2].z, -longest, 1e-12);
  EXPECT_NEAR(marker.points[14].x, 1.0, 1e-12);
  EXPECT_NEAR(marker.points[14].z, 0.5 * longest, 1e-12);
  for (std::size_t i = 0; i < marker.points.size(); i += 3) {
    Eigen::Vector3d p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] << marker.points[i + k].x, marker.points[i + k].y, marker.points[i + k].z;
    const Eigen::Vector3d inside(i < 12 ? 0.0 : 1.0, 0.0, i < 12 ? -0.1 * longest : 0.1 * longest);
    EXPECT_GT((p[1] - p[0]).cross(p[2] - p[0]).dot(p[0] - inside), 0.0) << "triangle " << i / 3;
  }
}

}  // namespace
}  // namespace tissue_stiffness
