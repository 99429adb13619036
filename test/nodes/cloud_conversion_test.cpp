#include <gtest/gtest.h>

#include <limits>

#include "cloud.hpp"
#include "expect_input_error.hpp"
#include "nodes/sensor_conversions.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVertices = 100;

ObservationSettings vertices() {
  ObservationSettings settings;
  settings.topic = "/tissue/vertices";
  settings.noise = 1e-3;
  return settings;
}

sensor_msgs::PointCloud2 two_vertices() {
  return make_cloud({{0.1F, 0.2F, 0.3F}, {-0.1F, 0.0F, 0.5F}}, "vertex", {7, 42});
}

Observation convert(const sensor_msgs::PointCloud2& cloud, const ObservationSettings& settings = vertices()) {
  return to_observation(cloud, settings, 3, kVertices, Eigen::Isometry3d::Identity());
}

TEST(CloudConversion, ReadsVerticesWithTheirNumbers) {
  const Observation out = convert(two_vertices());
  EXPECT_EQ(out.source, 3);
  EXPECT_EQ(out.kind, ObservationKind::vertices);
  EXPECT_DOUBLE_EQ(out.time, 10.5);
  ASSERT_EQ(out.points.cols(), 2);
  EXPECT_NEAR(out.points(2, 1), 0.5, 1e-7);
  EXPECT_EQ(out.ids[1], 42);
}

TEST(CloudConversion, TurnsAndMovesIntoTheModelFrame) {
  Eigen::Isometry3d pose = Eigen::Translation3d(1.0, 0.0, 0.0) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const Observation out = to_observation(two_vertices(), vertices(), 0, kVertices, pose);
  EXPECT_TRUE(out.points.col(0).isApprox(Eigen::Vector3d(0.8, 0.1, 0.3), 1e-6)) << out.points.col(0).transpose();
}

TEST(CloudConversion, ReadsRowsOfAnOrganisedCloudWithPadding) {
  sensor_msgs::PointCloud2 cloud = two_vertices();
  cloud.height = 2;
  cloud.width = 1;
  cloud.row_step = 24;
  std::vector<std::uint8_t> padded(48);
  std::copy_n(cloud.data.begin(), 16, padded.begin());
  std::copy_n(cloud.data.begin() + 16, 16, padded.begin() + 24);
  cloud.data = padded;
  const Observation out = convert(cloud);
  ASSERT_EQ(out.points.cols(), 2);
  EXPECT_EQ(out.ids[1], 42);
}

TEST(CloudConversion, LeavesOutInvalidPointsOfACloudThatIsNotDense) {
  sensor_msgs::PointCloud2 cloud =
      make_cloud({{std::numeric_limits<float>::quiet_NaN(), 0, 0}, {1, 2, 3}}, "vertex", {1, 2});
  expect_input_error([&] { convert(cloud); }, {"/tissue/vertices", "point 0", "not finite", "is_dense"});
  cloud.is_dense = 0;
  const Observation out = convert(cloud);
  ASSERT_EQ(out.points.cols(), 1);
  EXPECT_EQ(out.ids[0], 2);
}

TEST(CloudConversion, PointsNeedNoNumber) {
  ObservationSettings settings = vertices();
  settings.kind = ObservationSettings::Kind::points;
  sensor_msgs::PointCloud2 cloud = two_vertices();
  cloud.fields.pop_back();
  EXPECT_EQ(convert(cloud, settings).ids.size(), 0);
  expect_input_error([&] { convert(cloud); }, {"/tissue/vertices", "x, y, z", "a field vertex"});
}

TEST(CloudConversion, AnEmptyCloudIsAnEmptyObservation) {
  EXPECT_EQ(convert(make_cloud({}, "vertex", {})).points.cols(), 0);
}

TEST(CloudConversion, RefusesNumbersOutOfRange) {
  expect_input_error([&] { convert(make_cloud({{0, 0, 0}}, "vertex", {kVertices})); }, {"field vertex", "100", "0 to 99"});
  expect_input_error([&] { convert(make_cloud({{0, 0, 0}}, "vertex", {-1})); }, {"field vertex", "-1", "0 to 99"});
  ObservationSettings markers = vertices();
  markers.kind = ObservationSettings::Kind::markers;
  markers.rest = Eigen::Matrix3Xd::Zero(3, 2);
  expect_input_error([&] { convert(make_cloud({{0, 0, 0}}, "marker", {2}), markers); }, {"field marker", "2", "0 to 1"});
}

TEST(CloudConversion, RefusesAWrongLayout) {
  sensor_msgs::PointCloud2 cloud = two_vertices();
  cloud.is_bigendian = 1;
  expect_input_error([&] { convert(cloud); }, {"is_bigendian", "little endian"});
  cloud = two_vertices();
  cloud.data.pop_back();
  expect_input_error([&] { convert(cloud); }, {"31 bytes", "32"});
  cloud = two_vertices();
  cloud.row_step = 8;
  expect_input_error([&] { convert(cloud); }, {"row_step 8", "32"});
  cloud = two_vertices();
  cloud.fields[3].datatype = sensor_msgs::PointField::FLOAT32;
  expect_input_error([&] { convert(cloud); }, {"field vertex", "datatype 7", "integer"});
  cloud = two_vertices();
  cloud.fields[0].datatype = sensor_msgs::PointField::INT32;
  expect_input_error([&] { convert(cloud); }, {"field x", "datatype 5", "FLOAT32"});
  cloud = two_vertices();
  cloud.fields[1].offset = 14;
  expect_input_error([&] { convert(cloud); }, {"field y", "offset 14", "point_step 16"});
  cloud = two_vertices();
  cloud.fields[2].count = 3;
  expect_input_error([&] { convert(cloud); }, {"field z", "count 3"});
}

}  // namespace
}  // namespace tissue_stiffness
