#include <gtest/gtest.h>

#include "synthetic_images.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

const cv::Size size(400, 320);
const Eigen::Vector2d centre(150.0, 180.0);

std::unique_ptr<Segmenter> silhouette(const PixelBox& roi, std::optional<Eigen::Vector2d> seed = {}) {
  SegmentationSettings settings;
  settings.seed = seed;
  settings.roi = roi;
  return make_segmenter(settings);
}

/// A grey disc in a room with a bright window, whose frame is the sharpest edge of the image.
cv::Mat room(double radius) {
  const auto inside = [&](double u, double v) { return std::hypot(u - centre.x(), v - centre.y()) < radius; };
  cv::Mat background = texture(size, 50.0, 8.0, 15.0, 2);
  background(cv::Rect(290, 20, 80, 90)) = 240.0;
  return camera_image(texture(size, 130.0, 4.0, 6.0, 1), background, coverage(size, inside), 0.9, 3.0, 3);
}

std::function<double(const Eigen::Vector2d&)> to_circle(double radius) {
  return [=](const Eigen::Vector2d& p) { return (p - centre).norm() - radius; };
}

TEST(region_of_interest, window_outside_is_not_the_body) {
  SegmentationSettings whole;
  const Segmentation window = make_segmenter(whole)->segment(room(60.0), 0.0);
  EXPECT_TRUE(!window.found() || window.contour.points.row(0).mean() > 280.0) << "the image does not need a region";
  const Segmentation found = silhouette({40, 80, 230, 220})->segment(room(60.0), 2.5);
  ASSERT_TRUE(found.found()) << found.reason;
  EXPECT_EQ(found.contour.stamp, 2.5);
  EXPECT_EQ(found.contour.width, size.width);
  EXPECT_EQ(found.contour.height, size.height);
  const Errors errors = errors_of(found.contour, to_circle(60.0));
  EXPECT_NEAR(errors.mean, 0.0, 0.1);
  EXPECT_LT(errors.worst, 1.0);
}

TEST(region_of_interest, seed_is_a_pixel_of_the_whole_image) {
  const auto inside = [](double u, double v) {
    return std::hypot(u - 120.0, v - 200.0) < 40.0 || std::hypot(u - 280.0, v - 200.0) < 40.0;
  };
  const cv::Mat image = camera_image(texture(size, 140.0, 3.0, 5.0, 1), texture(size, 50.0, 5.0, 15.0, 2),
                                     coverage(size, inside), 1.0, 3.0, 3);
  for (const double u : {120.0, 280.0}) {
    const Segmentation found = silhouette({60, 120, 300, 190}, Eigen::Vector2d(u, 200.0))->segment(image, 0.0);
    ASSERT_TRUE(found.found()) << found.reason;
    EXPECT_NEAR(found.contour.points.row(0).mean(), u, 1.0);
  }
}

TEST(region_of_interest, outline_at_its_border_is_refused) {
  const auto segmenter = silhouette({120, 80, 150, 220});
  const Segmentation found = segmenter->segment(room(60.0), 0.0);
  EXPECT_FALSE(found.found());
  EXPECT_NE(found.reason.find("border of the region of interest"), std::string::npos) << found.reason;
  EXPECT_TRUE(segmenter->segment(room(22.0), 1.0).found()) << "a refused image is not remembered";
}

TEST(region_of_interest, outside_of_the_image_is_an_input_error) {
  EXPECT_THROW(silhouette({300, 80, 150, 220})->segment(room(60.0), 0.0), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
