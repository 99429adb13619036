#include "nodes/sensor_conversions.hpp"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <limits>
#include <opencv2/core.hpp>

#include "expect_input_error.hpp"

namespace tissue_stiffness {
namespace {

sensor_msgs::CameraInfo camera_info() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.D = {0.1, -0.2, 0.001, 0.002, 0.05};
  info.K = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  return info;
}

Camera convert(const sensor_msgs::CameraInfo& info) {
  return to_camera(info, ObservationSettings(), Eigen::Isometry3d::Identity(), "/camera_info");
}

ObservationSettings contour(const std::string& topic, std::optional<bool> rectified) {
  ObservationSettings settings;
  settings.topic = topic;
  settings.rectified = rectified;
  return settings;
}

sensor_msgs::ImagePtr image(const std::string& encoding, int channels, std::uint8_t value) {
  const auto out = sensor_msgs::ImagePtr(new sensor_msgs::Image);
  out->encoding = encoding;
  out->width = 4;
  out->height = 3;
  out->step = static_cast<std::uint32_t>(4 * channels);
  out->data.assign(out->step * out->height, value);
  return out;
}

TEST(CameraConversion, ReadsCalibration) {
  const Camera camera = convert(camera_info());
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.fx, 500);
  EXPECT_EQ(camera.fy, 510);
  EXPECT_EQ(camera.cy, 240);
  EXPECT_EQ(camera.lens, Camera::Lens::plumb_bob);
  EXPECT_EQ(camera.distortion[4], 0.05);
  EXPECT_EQ(camera.projection, Camera::Projection::pinhole);
}

TEST(CameraConversion, RefusesWhatItCannotUse) {
  sensor_msgs::CameraInfo info = camera_info();
  info.K[0] = 0;
  expect_input_error([&] { convert(info); }, {"/camera_info: K", "calibrate"});
  info = camera_info();
  info.K[2] = std::numeric_limits<double>::infinity();
  expect_input_error([&] { convert(info); }, {"/camera_info: K", "finite"});
  info = camera_info();
  info.distortion_model = "thin_prism";
  expect_input_error([&] { convert(info); }, {"thin_prism", "plumb_bob", "rational_polynomial", "equidistant"});
  info = camera_info();
  info.D.resize(3);
  expect_input_error([&] { convert(info); }, {"D", "3 numbers"});
  info = camera_info();
  info.binning_x = 2;
  expect_input_error([&] { convert(info); }, {"binning", "2"});
  info = camera_info();
  info.roi.x_offset = 10;
  expect_input_error([&] { convert(info); }, {"roi", "full image"});
  info = camera_info();
  info.height = 0;
  expect_input_error([&] { convert(info); }, {"640 x 0"});
}

TEST(CameraConversion, TakesPAndROfRectifiedImages) {
  sensor_msgs::CameraInfo info = camera_info();
  info.P = {400, 0, 310, 0, 0, 410, 230, 0, 0, 0, 1, 0};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int i = 0; i < 9; ++i) info.R[static_cast<std::size_t>(i)] = turn(i / 3, i % 3);
  const auto rectified = [&](const std::string& topic, std::optional<bool> stated) {
    return to_camera(info, contour(topic, stated), Eigen::Isometry3d::Identity(), "/camera_info");
  };
  const Camera camera = rectified("/image_rect", true);
  EXPECT_EQ(camera.lens, Camera::Lens::none);
  EXPECT_EQ(camera.fx, 400);
  EXPECT_EQ(camera.fy, 410);
  EXPECT_EQ(camera.cx, 310);
  EXPECT_EQ(camera.cy, 230);
  // A point along the rectified axis lies on the principal point of the rectified image.
  EXPECT_LT((camera.project(turn.transpose() * Eigen::Vector3d(0, 0, 2)) - Eigen::Vector2d(310, 230)).norm(), 1e-9);
  expect_input_error([&] { rectified("/camera/image_rect_color", std::nullopt); },
                     {"/camera/image_rect_color", "rectified: true"});
  EXPECT_EQ(rectified("/camera/image_rect", false).lens, Camera::Lens::plumb_bob);
  EXPECT_EQ(rectified("/camera/image_raw", std::nullopt).fx, 500);
  info.R.fill(0.0);
  expect_input_error([&] { rectified("/image_rect", true); }, {"/camera_info: R", "rotation"});
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P.fill(0.0);
  expect_input_error([&] { rectified("/image_rect", true); }, {"/camera_info: P", "calibrate"});
}

TEST(CameraConversion, RefusesImagesOfAnotherSize) {
  EXPECT_NO_THROW(require_image_size({640, 480}, {640, 480}, "/image", "/camera_info"));
  for (const cv::Size& size : {cv::Size(640, 479), cv::Size(480, 640)}) {
    expect_input_error(
        [&] {
          require_image_size(size, {640, 480}, "/image", "/camera_info");
        },
        {"/image", std::to_string(size.width) + " x " + std::to_string(size.height), "640 x 480 as in /camera_info"});
  }
}

TEST(ImageConversion, GivesGreyOrBgr) {
  EXPECT_EQ(to_image(image("mono8", 1, 7), "/image").type(), CV_8UC1);
  EXPECT_EQ(to_image(image("8UC1", 1, 7), "/image").type(), CV_8UC1);
  EXPECT_EQ(to_image(image("bgr8", 3, 7), "/image").type(), CV_8UC3);
  EXPECT_EQ(to_image(image("bgra8", 4, 7), "/image").type(), CV_8UC3);
  const cv::Mat narrowed = to_image(image("16UC1", 2, 128), "/image");
  EXPECT_EQ(narrowed.type(), CV_8UC1);
  EXPECT_NEAR(narrowed.at<std::uint8_t>(1, 1), 128, 1);
  sensor_msgs::ImagePtr red = image("rgb8", 3, 0);
  red->data[0] = 255;
  EXPECT_EQ(to_image(red, "/image").at<cv::Vec3b>(0, 0)[2], 255);
}

TEST(ImageConversion, RefusesWrongImages) {
  expect_input_error([] { to_image(image("32FC1", 4, 1), "/image"); }, {"/image", "32FC1", "mono8"});
  expect_input_error([] { to_image(image("holiday", 1, 1), "/image"); }, {"/image", "holiday"});
  const sensor_msgs::ImagePtr cut = image("mono8", 1, 1);
  cut->data.resize(5);
  expect_input_error([&] { to_image(cut, "/image"); }, {"/image", "mono8"});
  const sensor_msgs::ImagePtr empty = image("mono8", 1, 1);
  empty->width = empty->height = empty->step = 0;
  empty->data.clear();
  expect_input_error([&] { to_image(empty, "/image"); }, {"/image"});
}

TEST(ImageConversion, KeepsAMaskOfAnyDepth) {
  const auto kind = SegmentationSettings::Kind::mask;
  for (const char* encoding : {"mono8", "8UC1", "mono16", "16UC1"}) {
    const int bytes = std::string(encoding).find("16") == std::string::npos ? 1 : 2;
    const sensor_msgs::ImagePtr mask = image(encoding, bytes, 0);
    mask->data[static_cast<std::size_t>(5 * bytes)] = 1;  // column 1 of row 1
    const cv::Mat out = to_image(mask, kind, "/mask");
    ASSERT_EQ(out.type(), CV_8UC1) << encoding;
    EXPECT_EQ(out.at<std::uint8_t>(1, 1), 255) << encoding;
    EXPECT_EQ(cv::countNonZero(out), 1) << encoding;
  }
  EXPECT_EQ(to_image(image("mono8", 1, 7), SegmentationSettings::Kind::silhouette, "/image").at<std::uint8_t>(0, 0), 7);
}

TEST(ImageConversion, RefusesWhatIsNoMask) {
  const auto kind = SegmentationSettings::Kind::mask;
  for (const char* encoding : {"rgb8", "bgr8", "32FC1", "holiday"}) {
    expect_input_error([&] { to_image(image(encoding, 4, 1), kind, "/mask"); },
                       {"/mask", encoding, "mono8", "mono16", "16UC1"});
  }
  const sensor_msgs::ImagePtr cut = image("mono16", 2, 1);
  cut->data.resize(5);
  expect_input_error([&] { to_image(cut, kind, "/mask"); }, {"/mask", "mono16"});
  const sensor_msgs::ImagePtr empty = image("mono8", 1, 1);
  empty->width = empty->height = empty->step = 0;
  empty->data.clear();
  expect_input_error([&] { to_image(empty, kind, "/mask"); }, {"/mask"});
}

TEST(LoadConversion, TurnsAWrenchIntoTheModelFrame) {
  geometry_msgs::WrenchStamped wrench;
  wrench.wrench.force.x = 2.0;
  wrench.wrench.torque.z = 0.5;
  Eigen::Isometry3d pose = Eigen::Translation3d(5, 5, 5) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const LoadSample sample = to_load(wrench, pose, "/tool/wrench");
  ASSERT_EQ(sample.value.size(), 6);
  EXPECT_NEAR(sample.value[1], 2.0, 1e-12);
  EXPECT_NEAR(sample.value[5], 0.5, 1e-12);
  wrench.wrench.force.y = std::numeric_limits<double>::quiet_NaN();
  expect_input_error([&] { to_load(wrench, pose, "/tool/wrench"); }, {"/tool/wrench", "finite"});
}

TEST(LoadConversion, RefusesAPressureThatIsNotFinite) {
  sensor_msgs::FluidPressure pressure;
  pressure.fluid_pressure = 1200.0;
  EXPECT_EQ(to_load(pressure, "/p").value[0], 1200.0);
  pressure.fluid_pressure = std::numeric_limits<double>::quiet_NaN();
  expect_input_error([&] { to_load(pressure, "/p"); }, {"/p: fluid_pressure", "finite"});
}

TEST(PoseConversion, RefusesWhatIsNoRotation) {
  geometry_msgs::Transform transform;
  expect_input_error([&] { to_isometry(transform, "/tf"); }, {"/tf: rotation", "length 1"});
  transform.rotation.w = 1.0;
  transform.translation.z = 0.25;
  EXPECT_EQ(to_isometry(transform, "/tf").translation().z(), 0.25);
}

TEST(StampConversion, RefusesZero) {
  std_msgs::Header header;
  expect_input_error([&] { require_stamp(header, "/image"); }, {"/image: header.stamp"});
  header.stamp = ros::Time(1, 0);
  EXPECT_NO_THROW(require_stamp(header, "/image"));
}

}  // namespace
}  // namespace tissue_stiffness
