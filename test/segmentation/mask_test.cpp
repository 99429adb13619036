#include <gtest/gtest.h>

#include "synthetic_images.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

const cv::Size size(320, 240);
const Eigen::Vector2d centre(150.3, 118.8);

std::unique_ptr<Segmenter> mask_segmenter(std::optional<Eigen::Vector2d> seed = {}, std::optional<PixelBox> roi = {}) {
  SegmentationSettings settings;
  settings.kind = SegmentationSettings::Kind::mask;
  settings.seed = seed;
  settings.roi = roi;
  return make_segmenter(settings);
}

/// A pixel is body where its centre is inside.
cv::Mat mask_of(const std::function<bool(double, double)>& inside, int value = 1) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8U);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      if (inside(u, v)) mask.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(value);
    }
  }
  return mask;
}

cv::Mat disc(const Eigen::Vector2d& middle, double radius) {
  return mask_of([=](double u, double v) { return std::hypot(u - middle.x(), v - middle.y()) < radius; });
}

std::function<double(const Eigen::Vector2d&)> to_circle(const Eigen::Vector2d& middle, double radius) {
  return [=](const Eigen::Vector2d& p) { return (p - middle).norm() - radius; };
}

TEST(mask, disc_without_bias_and_with_honest_sigma) {
  const Segmentation found = mask_segmenter()->segment(disc(centre, 60.4), 1.5);
  ASSERT_TRUE(found.found()) << found.reason;
  EXPECT_EQ(found.contour.stamp, 1.5);
  EXPECT_EQ(found.contour.width, size.width);
  EXPECT_EQ(found.contour.height, size.height);
  const Errors errors = errors_of(found.contour, to_circle(centre, 60.4));
  EXPECT_EQ(errors.count, found.contour.size());
  EXPECT_NEAR(errors.mean, 0.0, 0.05);
  EXPECT_LT(errors.worst, 0.7);
  EXPECT_GT(errors.nis, 0.05);
  EXPECT_LT(errors.nis, 1.5);
  for (Eigen::Index i = 0; i < found.contour.size(); ++i) {
    EXPECT_GT(found.contour.normals.col(i).dot((found.contour.points.col(i) - centre).normalized()), 0.95);
  }
}

// A network that works at a quarter of the resolution leaves steps of four pixels, and the sigma says so.
TEST(mask, enlarged_mask_has_the_sigma_of_its_steps) {
  cv::Mat small, coarse;
  cv::resize(255 * disc(centre, 60.4), small, {}, 0.25, 0.25, cv::INTER_AREA);
  cv::resize(small > 127, coarse, size, 0, 0, cv::INTER_NEAREST);
  const Contour fine = mask_segmenter()->segment(disc(centre, 60.4), 0.0).contour;
  const Contour contour = mask_segmenter()->segment(coarse, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  EXPECT_GT(contour.sigma.mean(), 1.5 * fine.sigma.mean());
  EXPECT_LT(errors_of(contour, to_circle(centre, 60.4)).nis, 4.0);
}

TEST(mask, straight_edges_lie_between_the_pixels) {
  const cv::Mat mask = mask_of([](double u, double v) { return u > 79.5 && u < 220.5 && v > 99.5 && v < 160.5; }, 255);
  const Contour contour = mask_segmenter()->segment(mask, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  int top = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2d p = contour.points.col(i);
    if (p.x() < 95.0 || p.x() > 205.0) continue;
    EXPECT_NEAR(p.y(), p.y() < 130.0 ? 99.5 : 160.5, 0.05);
    ++top;
  }
  EXPECT_GT(top, 60);
}

TEST(mask, holes_are_filled_and_specks_are_ignored) {
  cv::Mat mask = disc(centre, 60.4);
  mask.setTo(0, disc(centre + Eigen::Vector2d(10.0, -5.0), 20.0));
  mask.setTo(1, disc({280.0, 40.0}, 12.0));
  const Contour contour = mask_segmenter()->segment(mask, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  EXPECT_LT(errors_of(contour, to_circle(centre, 60.4)).worst, 0.7);
}

TEST(mask, seed_or_region_of_interest_chooses_the_part) {
  const Eigen::Vector2d large(90.0, 120.0), little(250.0, 110.0);
  const cv::Mat mask = disc(large, 60.0) + disc(little, 20.0);
  const auto middle = [&](const std::unique_ptr<Segmenter>& segmenter) {
    const Segmentation found = segmenter->segment(mask, 0.0);
    EXPECT_TRUE(found.found()) << found.reason;
    return found.found() ? found.contour.points.row(0).mean() : 0.0;
  };
  EXPECT_NEAR(middle(mask_segmenter()), large.x(), 1.0);
  EXPECT_NEAR(middle(mask_segmenter(little)), little.x(), 1.0);
  // The region need not hold the whole body.
  EXPECT_NEAR(middle(mask_segmenter({}, PixelBox{240, 60, 40, 60})), little.x(), 1.0);
  EXPECT_NEAR(middle(mask_segmenter({}, PixelBox{0, 100, 320, 40})), large.x(), 1.0);
}

TEST(mask, refuses_what_it_would_have_to_guess) {
  const cv::Mat none = cv::Mat::zeros(size, CV_8U), one = disc(centre, 40.0);
  const auto reason = [](const std::unique_ptr<Segmenter>& segmenter, const cv::Mat& mask) {
    const Segmentation found = segmenter->segment(mask, 0.0);
    EXPECT_FALSE(found.found());
    return found.reason;
  };
  EXPECT_EQ(reason(mask_segmenter(), none), "the mask is 0 everywhere");
  EXPECT_EQ(reason(mask_segmenter(Eigen::Vector2d(5.0, 5.0)), one), "the mask is 0 at the seed");
  EXPECT_EQ(reason(mask_segmenter({}, PixelBox{0, 0, 40, 40}), one), "the mask is 0 in the region of interest");
  EXPECT_NE(reason(mask_segmenter(), disc({80.0, 120.0}, 40.0) + disc({240.0, 120.0}, 35.0)).find("similar size"),
            std::string::npos);
  EXPECT_NE(reason(mask_segmenter(), disc(centre, 4.0)).find("largest part has"), std::string::npos);
  EXPECT_NE(reason(mask_segmenter(), cv::Mat(size, CV_8U, cv::Scalar(1))).find("image's border"), std::string::npos);
  EXPECT_NE(reason(mask_segmenter(), cv::Mat::ones(20, 20, CV_8U)).find("32 x 32"), std::string::npos);
}

TEST(mask, border_of_the_image_is_no_edge) {
  const Contour contour = mask_segmenter()->segment(disc({20.0, 120.0}, 60.0), 0.0).contour;
  ASSERT_FALSE(contour.empty());
  int hidden = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    if (contour.points(0, i) > 4.0) continue;
    if (std::abs(contour.points(1, i) - 120.0) > 50.0) continue;
    EXPECT_FALSE(std::isfinite(contour.sigma(i)));
    ++hidden;
  }
  EXPECT_GT(hidden, 20);
}

TEST(mask, wrong_images_and_places_are_input_errors) {
  EXPECT_THROW(mask_segmenter()->segment(cv::Mat(), 0.0), InputError);
  EXPECT_THROW(mask_segmenter()->segment(cv::Mat::zeros(size, CV_8UC3), 0.0), InputError);
  EXPECT_THROW(mask_segmenter(Eigen::Vector2d(400.0, 5.0))->segment(disc(centre, 40.0), 0.0), InputError);
  EXPECT_THROW(mask_segmenter({}, PixelBox{300, 0, 40, 40})->segment(disc(centre, 40.0), 0.0), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
