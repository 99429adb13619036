#include "segmentation/lens.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "synthetic_images.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

struct Calibration {
  std::string model;
  std::vector<double> coefficients;
};

const Calibration kCalibrations[] = {{"plumb_bob", {-0.3, 0.1, 0.001, -0.0005}},
                                     {"plumb_bob", {0.2, -0.05, 0.001, 0.002, 0.01}},
                                     {"rational_polynomial", {0.4, -0.2, 1e-4, -2e-4, 0.03, 0.7, -0.1, 0.01}},
                                     {"equidistant", {0.1, -0.05, 0.02, 0.0}},
                                     {"equidistant", {0.0, 0.0, 0.0, 0.0}}};

Camera camera_with(const Calibration& calibration) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 500.0;
  camera.fy = 520.0;
  camera.cx = 310.0;
  camera.cy = 245.0;
  set_lens(calibration.model, calibration.coefficients, "/camera_info", &camera);
  return camera;
}

std::string error_of(const Calibration& calibration, Camera::Projection projection = Camera::Projection::pinhole) {
  Camera camera;
  camera.projection = projection;
  try {
    set_lens(calibration.model, calibration.coefficients, "/camera_info", &camera);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Eigen::Matrix2Xd grid() {
  Eigen::Matrix2Xd points(2, 99);
  for (Eigen::Index i = 0; i < points.cols(); ++i) points.col(i) << 64.0 * double(i % 11), 60.0 * double(i / 11);
  return points;
}

TEST(Lens, IsUndoneByItsInverse) {
  for (const Calibration& calibration : kCalibrations) {
    const Camera camera = camera_with(calibration);
    const Eigen::Matrix2Xd seen = distort(camera, grid());
    EXPECT_GT((seen - grid()).colwise().norm().maxCoeff(), 5.0) << calibration.model << " does nothing";
    const Eigen::Matrix2Xd back = undistort(camera, seen);
    EXPECT_LT((back - grid()).colwise().norm().maxCoeff(), 0.05) << calibration.model;
  }
}

// The formulas of the calibration, written out.
TEST(Lens, MovesAPointAsTheFormulasSay) {
  const double x = 0.3, y = -0.2, r2 = x * x + y * y, r = std::sqrt(r2);
  const Eigen::Vector2d point(310.0 + 500.0 * x, 245.0 + 520.0 * y);
  const auto seen = [&](double factor) { return Eigen::Vector2d(310.0 + 500.0 * x * factor, 245.0 + 520.0 * y * factor); };
  const auto moved = [&](const Calibration& calibration) -> Eigen::Vector2d {
    return distort(camera_with(calibration), Eigen::Matrix2Xd(point)).col(0);
  };
  const double r4 = r2 * r2, r6 = r4 * r2;
  EXPECT_LT((moved({"plumb_bob", {-0.3, 0.1, 0, 0, 0.02}}) - seen(1 - 0.3 * r2 + 0.1 * r4 + 0.02 * r6)).norm(), 1e-9);
  const double ratio = (1 + 0.4 * r2 - 0.2 * r4 + 0.03 * r6) / (1 + 0.7 * r2 - 0.1 * r4 + 0.01 * r6);
  EXPECT_LT((moved({"rational_polynomial", {0.4, -0.2, 0, 0, 0.03, 0.7, -0.1, 0.01}}) - seen(ratio)).norm(), 1e-9);
  const double angle = std::atan(r), bent = angle * (1 + 0.1 * std::pow(angle, 2) - 0.05 * std::pow(angle, 4));
  EXPECT_LT((moved({"equidistant", {0.1, -0.05, 0, 0}}) - seen(bent / r)).norm(), 1e-9);
  const double u = 310 + 500 * (x + 2 * 0.01 * x * y + 0.02 * (r2 + 2 * x * x));
  const double v = 245 + 520 * (y + 0.01 * (r2 + 2 * y * y) + 2 * 0.02 * x * y);
  EXPECT_LT((moved({"plumb_bob", {0, 0, 0.01, 0.02}}) - Eigen::Vector2d(u, v)).norm(), 1e-9);
}

// An ellipse is bent by the lens. Straightened, it has its places, its normals, and sigmas that grow as the lens shrinks.
TEST(Lens, ContourIsStraightenedWithItsNormals) {
  const Camera camera = camera_with(kCalibrations[0]);
  const Eigen::Index n = 200;
  Eigen::Matrix2Xd truth(2, n), outward(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(n);
    truth.col(i) << 380.0 + 200.0 * std::cos(angle), 200.0 + 120.0 * std::sin(angle);
    outward.col(i) = Eigen::Vector2d(std::cos(angle) / 200.0, std::sin(angle) / 120.0).normalized();
  }
  Contour contour;
  contour.points = distort(camera, truth);
  contour.sigma = Eigen::VectorXd::Constant(n, 0.2);
  const Eigen::Matrix2Xd ahead = distort(camera, truth + 0.01 * outward);
  Eigen::Matrix2Xd tangents(2, n);
  for (Eigen::Index i = 0; i < n; ++i)
    tangents.col(i) = contour.points.col((i + 1) % n) - contour.points.col((i + n - 1) % n);
  contour.normals.resize(2, n);
  contour.normals << tangents.row(1), -tangents.row(0);
  contour.normals.colwise().normalize();
  undistort(camera, &contour);
  EXPECT_LT((contour.points - truth).colwise().norm().maxCoeff(), 0.05);
  for (Eigen::Index i = 0; i < n; ++i) {
    EXPECT_GT(contour.normals.col(i).dot(outward.col(i)), 0.999) << i;
    const double shrunk = (ahead.col(i) - distort(camera, truth.col(i)).col(0)).norm() / 0.01;
    EXPECT_NEAR(contour.sigma(i), 0.2 / shrunk, 0.02) << i;
  }
  EXPECT_GT(contour.sigma.maxCoeff(), 1.2 * contour.sigma.minCoeff());
}

/// The picture that the lens makes of the image of a pinhole.
cv::Mat seen_through(const Camera& camera, const cv::Mat& image) {
  Eigen::Matrix2Xd pixels(2, Eigen::Index{image.cols} * image.rows);
  for (Eigen::Index i = 0; i < pixels.cols(); ++i) pixels.col(i) << double(i % image.cols), double(i / image.cols);
  const Eigen::Matrix2Xf sources = undistort(camera, pixels).cast<float>();
  const cv::Mat map(image.rows, image.cols, CV_32FC2, const_cast<float*>(sources.data()));
  cv::Mat out;
  cv::remap(image, out, map, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return out;
}

TEST(Lens, OutlineOfABodyIsTheSameThroughIt) {
  const Eigen::Vector2d centre(400.3, 190.6);
  const cv::Size size(640, 480);
  const auto inside = [&](double u, double v) { return std::hypot(u - centre.x(), v - centre.y()) < 130.4; };
  const auto to_circle = [&](const Eigen::Vector2d& p) { return (p - centre).norm() - 130.4; };
  const cv::Mat image = camera_image(texture(size, 150.0, 6.0, 6.0, 1), texture(size, 55.0, 10.0, 15.0, 2),
                                     coverage(size, inside), 0.9, 2.0, 3);
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}, std::size_t{3}}) {
    const Camera camera = camera_with(kCalibrations[k]);
    Contour contour = make_segmenter({})->segment(seen_through(camera, image), 0.0).contour;
    ASSERT_FALSE(contour.empty()) << k;
    EXPECT_GT(errors_of(contour, to_circle).worst, 4.0) << "the lens does nothing";
    undistort(camera, &contour);
    const Errors errors = errors_of(contour, to_circle);
    EXPECT_GT(errors.count, 0.9 * static_cast<double>(contour.size()));
    EXPECT_NEAR(errors.mean, 0.0, 0.05) << k;
    EXPECT_LT(errors.deviation, 0.25) << k;
  }
}

TEST(Lens, PointsThatNoPlaceIsSeenAtAreNotTrusted) {
  const Camera camera = camera_with({"plumb_bob", {-0.5, 0.0, 0.0, 0.0}});  // no ray is seen farther out than 272 pixels
  EXPECT_TRUE(undistort(camera, Eigen::Matrix2Xd(Eigen::Vector2d(400.0, 245.0))).allFinite());
  Contour contour;
  contour.points = Eigen::Vector2d(630.0, 245.0);
  contour.normals = Eigen::Vector2d(1.0, 0.0);
  contour.sigma = Eigen::VectorXd::Constant(1, 0.2);
  undistort(camera, &contour);
  EXPECT_FALSE(std::isfinite(contour.sigma(0)));
  EXPECT_TRUE(contour.points.allFinite());
}

TEST(Lens, WithoutOneNothingMoves) {
  for (const Calibration& calibration : {Calibration{"plumb_bob", {0, 0, 0, 0, 0}}, Calibration{"holiday", {}}}) {
    const Camera camera = camera_with(calibration);
    EXPECT_EQ(camera.lens, Camera::Lens::none);
    EXPECT_EQ(distort(camera, grid()), grid());
    EXPECT_EQ(undistort(camera, grid()), grid());
    const cv::Mat image(4, 5, CV_8U, cv::Scalar(7));
    EXPECT_EQ(undistort(camera, image).data, image.data);
  }
}

TEST(Lens, ImageIsStraightened) {
  for (const std::size_t k : {std::size_t{0}, std::size_t{3}}) {
    const Camera camera = camera_with(kCalibrations[k]);
    cv::Mat image = cv::Mat::zeros(480, 640, CV_8U);
    const Eigen::Vector2d seen = distort(camera, Eigen::Matrix2Xd(Eigen::Vector2d(500.0, 100.0))).col(0);
    image(cv::Rect(cvRound(seen.x()) - 2, cvRound(seen.y()) - 2, 5, 5)) = 255;
    const cv::Mat straight = undistort(camera, image);
    EXPECT_EQ(straight.size(), image.size());
    EXPECT_GT(int(straight.at<std::uint8_t>(100, 500)), 200) << k;
  }
}

TEST(Lens, BreaksBetweenPiecesRemain) {
  Eigen::Matrix2Xd points(2, 2);
  points << 100.0, std::numeric_limits<double>::quiet_NaN(), 100.0, std::numeric_limits<double>::quiet_NaN();
  for (const Calibration& calibration : kCalibrations) {
    const Eigen::Matrix2Xd moved = distort(camera_with(calibration), points);
    EXPECT_TRUE(moved.col(0).allFinite());
    EXPECT_TRUE(std::isnan(moved(0, 1)) && std::isnan(moved(1, 1))) << calibration.model;
  }
}

TEST(Lens, RefusesWhatItDoesNotKnow) {
  const auto says = [](const std::string& message, const std::vector<std::string>& words) {
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in " << message;
  };
  says(error_of({"thin_prism", {0.1}}), {"/camera_info", "'thin_prism'", "plumb_bob, rational_polynomial, equidistant"});
  says(error_of({"plumb_bob", {0.1, 0.1, 0.1}}), {"/camera_info: D", "3 numbers", "k1 k2 p1 p2"});
  says(error_of({"rational_polynomial", {0.1, 0.1, 0.1, 0.1, 0.1}}), {"5 numbers", "k6"});
  says(error_of({"equidistant", {0.1, 0.1, 0.1, 0.1, 0.1}}), {"5 numbers", "k4 of equidistant"});
  says(error_of({"plumb_bob", {0.1, std::nan(""), 0, 0}}), {"finite"});
  says(error_of({"plumb_bob", {0.1, 0, 0, 0}}, Camera::Projection::slice), {"plumb_bob", "slice"});
  EXPECT_EQ(error_of({"plumb_bob", {0, 0, 0, 0, 0}}, Camera::Projection::slice), "");
}

}  // namespace
}  // namespace tissue_stiffness
