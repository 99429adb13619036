#include "nodes/surface_view.hpp"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>

#include "nodes/model_outline.hpp"
#include "nodes/sensor_conversions.hpp"

namespace tissue_stiffness {
namespace {

TetMesh quadratic_tetrahedron() {
  TetMesh mesh;
  mesh.nodes.resize(3, 10);
  mesh.nodes.leftCols<4>() << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  const int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  for (int e = 0; e < 6; ++e) mesh.nodes.col(4 + e) = 0.5 * (mesh.nodes.col(edges[e][0]) + mesh.nodes.col(edges[e][1]));
  mesh.tets.resize(10, 1);
  mesh.tets << 0, 1, 2, 3, 4, 5, 6, 7, 8, 9;
  mesh.facets.resize(6, 4);
  mesh.facets.col(0) << 0, 2, 1, 6, 5, 4;
  mesh.facets.col(1) << 0, 1, 3, 4, 8, 7;
  mesh.facets.col(2) << 0, 3, 2, 7, 9, 6;
  mesh.facets.col(3) << 1, 2, 3, 5, 9, 8;
  mesh.facet_tet = Eigen::Vector4i::Zero();
  mesh.corner_count = 4;
  return mesh;
}

Misfit misfit() {
  Misfit out;
  out.node_error = Eigen::VectorXd::Constant(10, std::nan(""));
  out.node_sigmas = out.node_error;
  out.node_error[2] = 1e-3;
  out.node_sigmas[2] = 6.0;
  out.node_error[1] = out.node_sigmas[1] = 0.0;
  return out;
}

TEST(SurfaceMarker, ShowsAQuadraticFacetAsFourTrianglesTurnedOutwards) {
  const TetMesh mesh = quadratic_tetrahedron();
  const Eigen::Matrix3Xd moved = Eigen::Vector3d(0, 0, 1).replicate(1, 10);
  const visualization_msgs::Marker marker = surface_marker(mesh, moved, misfit(), 3.0, std_msgs::Header());
  ASSERT_EQ(marker.points.size(), 4U * 4U * 3U);
  ASSERT_EQ(marker.colors.size(), marker.points.size());
  const Eigen::Vector3d centre(0.25, 0.25, 1.25);
  double area = 0.0;
  for (std::size_t i = 0; i < marker.points.size(); i += 3) {
    Eigen::Vector3d p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] << marker.points[i + k].x, marker.points[i + k].y, marker.points[i + k].z;
    const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    EXPECT_GT(normal.dot(p[0] - centre), 0.0) << "triangle " << i / 3;
    area += 0.5 * normal.norm();
  }
  EXPECT_NEAR(area, 1.5 + std::sqrt(3.0) / 2.0, 1e-12);
}

TEST(SurfaceMarker, ColoursByMisfitAndInterpolatesBetweenMeasuredNodes) {
  const TetMesh mesh = quadratic_tetrahedron();
  const auto marker = surface_marker(mesh, Eigen::Matrix3Xd::Zero(3, 10), misfit(), 3.0, std_msgs::Header());
  for (std::size_t i = 0; i < marker.points.size(); ++i) {
    const auto& p = marker.points[i];
    const auto& c = marker.colors[i];
    if (p.y == 1.0) {
      EXPECT_TRUE(c.r > 0.4F && c.g < 0.2F * c.r && c.b < 0.4F * c.r) << "6 sigma is red";
    } else if (p.x == 1.0) {
      EXPECT_TRUE(c.b > 0.4F && c.r < 0.4F * c.b) << "0 sigma is blue";
    } else if (p.x == 0.5 && p.y == 0.5) {
      EXPECT_TRUE(c.r > 0.4F && c.g < 0.2F * c.r) << "the mean of 6 and 0 sigma is red";
    }
  }
}

TEST(SurfaceMarker, IsRedFromTheLimitOn) {
  const TetMesh mesh = quadratic_tetrahedron();
  const auto colour = [&](double limit) {  // of the node with 6 sigma
    const auto marker = surface_marker(mesh, Eigen::Matrix3Xd::Zero(3, 10), misfit(), limit, std_msgs::Header());
    for (std::size_t i = 0; i < marker.points.size(); ++i) {
      if (marker.points[i].y == 1.0) return marker.colors[i];
    }
    throw std::logic_error("the node is not shown");
  };
  EXPECT_EQ(colour(3.0), colour(6.0));
  EXPECT_GT(colour(12.0).g, 2.0F * colour(6.0).g) << "half of the limit is cream";
  EXPECT_GT(colour(1000.0).b, colour(1000.0).r) << "far below the limit is blue";
}

TEST(SurfaceMarker, IsGreyWhereNothingWasMeasuredAndBrighterTowardsTheLight) {
  const TetMesh mesh = quadratic_tetrahedron();
  Misfit nothing = misfit();
  nothing.node_sigmas.setConstant(std::nan(""));
  const auto marker = surface_marker(mesh, Eigen::Matrix3Xd::Zero(3, 10), nothing, 3.0, std_msgs::Header());
  float top = 0.0F, bottom = 0.0F;
  for (std::size_t i = 0; i < marker.points.size(); ++i) {
    const auto& c = marker.colors[i];
    EXPECT_TRUE(c.r == c.g && c.g == c.b && c.r > 0.3F);
    if (marker.points[i].x == 0.5 && marker.points[i].y == 0.0 && marker.points[i].z == 0.5) top = c.r;
    if (marker.points[i].x == 0.5 && marker.points[i].y == 0.5 && marker.points[i].z == 0.0) bottom = c.r;
  }
  EXPECT_GT(top, bottom);
}

TEST(SurfaceCloud, HoldsPositionDisplacementAndMisfitOfEachSurfaceNode) {
  const TetMesh mesh = quadratic_tetrahedron();
  Eigen::Matrix3Xd moved = Eigen::Matrix3Xd::Zero(3, 10);
  moved(0, 2) = 0.25;
  const sensor_msgs::PointCloud2 cloud = surface_cloud(mesh, moved, misfit(), std_msgs::Header());
  EXPECT_EQ(cloud.width, 10U);
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), dx(cloud, "dx"), error(cloud, "misfit");
  sensor_msgs::PointCloud2ConstIterator<float> sigma(cloud, "misfit_sigma");
  sensor_msgs::PointCloud2ConstIterator<std::int32_t> vertex(cloud, "vertex");
  for (; x != x.end(); ++x, ++dx, ++error, ++sigma, ++vertex) {
    EXPECT_EQ(*dx, *vertex == 2 ? 0.25F : 0.0F);
    EXPECT_FLOAT_EQ(*x, static_cast<float>(mesh.nodes(0, *vertex)) + *dx);
    if (*vertex == 2) {
      EXPECT_FLOAT_EQ(*error, 1e-3F);
      EXPECT_FLOAT_EQ(*sigma, 6.0F);
    } else if (*vertex != 1) {
      EXPECT_TRUE(std::isnan(*error));
    }
  }
  // What we publish can be read back as the points of a sensor.
  ObservationSettings settings;
  settings.topic = "tracked_points";
  EXPECT_EQ(to_observation(cloud, settings, 0, 10, Eigen::Isometry3d::Identity()).ids.size(), 10);
}

TEST(MeasuredCloud, HoldsThePointsOfEverySensorAndSaysWhose) {
  Frame frame;
  Observation markers, points, contour;
  markers.source = 2;
  markers.points = Eigen::Matrix3Xd::Random(3, 4);
  points.source = 0;
  points.points = Eigen::Matrix3Xd::Random(3, 3);
  contour.kind = ObservationKind::contour;
  frame.observations = {markers, contour, points};
  std_msgs::Header header;
  header.frame_id = "model";
  const sensor_msgs::PointCloud2 cloud = measured_cloud(frame, header);
  EXPECT_EQ(cloud.header.frame_id, "model");
  ASSERT_EQ(cloud.width, 7U);
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), z(cloud, "z");
  sensor_msgs::PointCloud2ConstIterator<std::int32_t> source(cloud, "source");
  for (int i = 0; i < 7; ++i, ++x, ++z, ++source) {
    const Observation& of = i < 4 ? markers : points;
    EXPECT_EQ(*source, of.source);
    EXPECT_FLOAT_EQ(*x, static_cast<float>(of.points(0, i < 4 ? i : i - 4)));
    EXPECT_FLOAT_EQ(*z, static_cast<float>(of.points(2, i < 4 ? i : i - 4)));
  }
  EXPECT_EQ(measured_cloud(Frame(), header).width, 0U);
}

TEST(ModelOutline, IsWhatThePinholeSees) {
  const TetMesh mesh = quadratic_tetrahedron();
  ModelSettings settings;
  ObservationSettings observation;
  observation.kind = ObservationSettings::Kind::contour;
  Camera camera;
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 100.0;
  camera.model_from_sensor.translation() = Eigen::Vector3d(0, 0, -1);  // looks along z at the face z = 0, 1 m away
  const Contour seen = ModelOutline(settings, observation, mesh).seen_by(camera, mesh.nodes);
  double left = 1e9, right = -1e9;
  for (Eigen::Index i = 0; i < seen.size(); ++i) {
    if (!seen.points.col(i).allFinite()) continue;
    const Eigen::Vector2d p = seen.points.col(i);
    const bool on_edge = std::abs(p.x()) < 1e-6 || std::abs(p.y()) < 1e-6 || std::abs(p.x() + p.y() - 100.0) < 1e-6;
    EXPECT_TRUE(on_edge) << p.transpose();
    left = std::min(left, p.x());
    right = std::max(right, p.x());
  }
  EXPECT_NEAR(left, 0.0, 1e-9);
  EXPECT_NEAR(right, 100.0, 1e-9);
}

}  // namespace
}  // namespace tissue_stiffness
