#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "synthetic_images.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

const cv::Size size(480, 400);

std::unique_ptr<Segmenter> cavity() {
  return make_segmenter({SegmentationSettings::Kind::cavity, {}});
}

struct Ellipse {
  Eigen::Vector2d centre{240.0, 210.0};
  Eigen::Vector2d axes{60.0, 100.0};

  double level(double u, double v) const { return std::hypot((u - centre.x()) / axes.x(), (v - centre.y()) / axes.y()); }
  /// Distance to the ellipse to first order, positive outside.
  double distance(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = (p - centre).cwiseQuotient(axes);
    return (d.norm() - 1.0) * d.norm() / d.cwiseQuotient(axes).norm();
  }
};

struct Scene {
  Ellipse ellipse;
  double base = 1e9;      ///< rows below which the cavity is open
  bool leaflets = false;  ///< thin strips from the wall into the cavity
  bool drop_out = false;  ///< a stretch of wall as dark as the pool
};

cv::Mat echo(const Scene& scene, unsigned seed) {
  Ellipse outer = scene.ellipse;
  outer.axes.array() += 32.0;
  cv::Mat strength(size, CV_32F);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const double inner_level = scene.ellipse.level(u, v), outer_level = outer.level(u, v);
      const double angle = std::atan2(v - scene.ellipse.centre.y(), u - scene.ellipse.centre.x());
      double value = 0.03;
      if (outer_level < 1.0) value = 1.0;
      if (scene.drop_out && std::abs(angle) < 0.35) value = 0.03;
      if (v > scene.base && std::abs(u - scene.ellipse.centre.x()) < outer.axes.x())
        value = inner_level < 1.0 ? 0.01 : value;
      if (inner_level < 1.0) value = 0.012;
      const double side = std::abs(u - scene.ellipse.centre.x());
      if (scene.leaflets && inner_level < 1.0 && std::abs(side - 34.0) < 3.0 && v > 240 && v < 290) value = 0.3;
      if (v > scene.base) value = side < 70.0 ? 0.012 : 0.03;
      strength.at<float>(v, u) = static_cast<float>(value);
    }
  }
  return echo_image(strength, 4.0, 1.5, seed);
}

Errors errors_above(const Contour& contour, const Scene& scene, double row) {
  Contour above = contour;
  for (Eigen::Index i = 0; i < above.size(); ++i) {
    if (above.points(1, i) > row) above.sigma(i) = std::numeric_limits<double>::infinity();
  }
  return errors_of(above, [&](const Eigen::Vector2d& p) { return scene.ellipse.distance(p); });
}

TEST(cavity, ellipse_in_speckle_without_bias_and_with_honest_sigma) {
  double mean = 0.0, nis = 0.0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Segmentation found = cavity()->segment(echo({}, seed), 2.0);
    ASSERT_TRUE(found.found()) << found.reason;
    EXPECT_EQ(found.contour.stamp, 2.0);
    const Errors errors = errors_above(found.contour, {}, 1e9);
    EXPECT_GT(errors.count, 0.9 * static_cast<double>(found.contour.size()));
    EXPECT_LT(errors.deviation, 1.6);
    mean += errors.mean / 5.0;
    nis += errors.nis / 5.0;
  }
  EXPECT_NEAR(mean, 0.0, 0.7);
  EXPECT_GT(nis, 0.3);
  EXPECT_LT(nis, 2.5);
}

TEST(cavity, normals_point_into_the_wall) {
  const Contour contour = cavity()->segment(echo({}, 3), 0.0).contour;
  ASSERT_FALSE(contour.empty());
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2d p = contour.points.col(i), n = contour.normals.col(i);
    EXPECT_NEAR(n.norm(), 1.0, 1e-12);
    EXPECT_GT(n.dot((p - Ellipse().centre).normalized()), 0.3);
  }
}

TEST(cavity, open_base_and_leaflets) {
  Scene scene;
  scene.base = 285.0;
  scene.leaflets = true;
  const Contour contour = cavity()->segment(echo(scene, 4), 0.0).contour;
  ASSERT_FALSE(contour.empty());
  const Errors wall = errors_above(contour, scene, 240.0);
  EXPECT_GT(wall.count, 60);
  EXPECT_LT(std::abs(wall.mean), 1.2);
  EXPECT_LT(wall.deviation, 1.8);
  int open = 0, trusted = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    if (contour.points(1, i) < 240.0 || std::abs(contour.points(0, i) - 240.0) > 25.0) continue;
    ++open;
    trusted += std::isfinite(contour.sigma(i));
  }
  EXPECT_GT(open, 5);
  EXPECT_EQ(trusted, 0);
}

TEST(cavity, drop_out_is_not_trusted_and_not_followed) {
  Scene scene;
  scene.drop_out = true;
  const Contour contour = cavity()->segment(echo(scene, 5), 0.0).contour;
  ASSERT_FALSE(contour.empty());
  int missing = 0, trusted = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2d d = contour.points.col(i) - scene.ellipse.centre;
    if (std::abs(std::atan2(d.y(), d.x())) > 0.2) continue;
    ++missing;
    trusted += std::isfinite(contour.sigma(i));
    EXPECT_LT(std::abs(scene.ellipse.distance(contour.points.col(i))), 15.0);
  }
  EXPECT_GT(missing, 3);
  EXPECT_EQ(trusted, 0);
  EXPECT_LT(std::abs(errors_above(contour, scene, 1e9).mean), 1.2);
}

// The previous frame is a search band, not an average: a steadily growing cavity is followed without lag.
TEST(cavity, grows_without_lag_through_an_empty_frame) {
  const auto segmenter = cavity();
  double early = 0.0, late = 0.0;
  for (int k = 0; k < 16; ++k) {
    Scene scene;
    scene.ellipse.axes.array() += 1.5 * k - 5.0;
    if (k == 8) {
      const Segmentation none = segmenter->segment(cv::Mat::zeros(size, CV_8U), k);
      EXPECT_FALSE(none.found());
      EXPECT_FALSE(none.reason.empty());
      continue;
    }
    const Segmentation found = segmenter->segment(echo(scene, 50 + static_cast<unsigned>(k)), k);
    ASSERT_TRUE(found.found()) << found.reason;
    const Errors errors = errors_above(found.contour, scene, 1e9);
    EXPECT_LT(std::abs(errors.mean), 1.2) << "frame " << k;
    (k < 8 ? early : late) += errors.mean / (k < 8 ? 8.0 : 7.0);
  }
  EXPECT_NEAR(early, late, 0.4);
}

TEST(cavity, nothing_to_find) {
  for (const int grey : {0, 100, 255}) {
    const Segmentation found = cavity()->segment(cv::Mat(size, CV_8U, cv::Scalar(grey)), 0.0);
    EXPECT_TRUE(found.contour.empty());
    EXPECT_FALSE(found.reason.empty());
  }
  for (unsigned seed = 0; seed < 5; ++seed) {
    EXPECT_FALSE(cavity()->segment(echo_image(cv::Mat::ones(size, CV_32F) * 0.3, 4.0, 1.5, seed), 0.0).found()) << seed;
    cv::Mat noise(size, CV_8U);
    cv::RNG(seed + 1).fill(noise, cv::RNG::UNIFORM, 0, 256);
    EXPECT_FALSE(cavity()->segment(noise, 0.0).found()) << seed;
  }
}

TEST(cavity, seed_colour_and_wrong_images) {
  const cv::Mat grey = echo({}, 6);
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  const auto segmenter = make_segmenter({SegmentationSettings::Kind::cavity, Eigen::Vector2d(250.0, 190.0)});
  const Contour first = segmenter->segment(grey, 0.0).contour;
  ASSERT_FALSE(first.empty());
  segmenter->reset();
  const Contour second = segmenter->segment(colour, 0.0).contour;
  ASSERT_EQ(first.size(), second.size());
  EXPECT_TRUE(first.points == second.points);
  EXPECT_LT(std::abs(errors_above(first, {}, 1e9).mean), 1.2);
  EXPECT_THROW(segmenter->segment(cv::Mat::zeros(size, CV_32F), 0.0), InputError);
}

// A simulated apical view at rest: half ellipsoid, inner semi-axes 20 and 50 mm, cut open 20 mm below its centre.
TEST(cavity, simulated_ventricle_at_rest) {
  const cv::Mat image = cv::imread(TISSUE_STIFFNESS_TEST_DATA "/segmentation/ventricle.png", cv::IMREAD_UNCHANGED);
  ASSERT_FALSE(image.empty());
  const Contour contour = cavity()->segment(image, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  const double metre_per_pixel = 0.284375e-3;
  const Eigen::Vector2d apex(-0.004, -0.082), axial(0.0697564737, 0.9975640503), lateral(0.9975640503, -0.0697564737);
  const Ellipse wall{{0.0, 0.0}, {0.02, 0.05}};
  const Errors errors = errors_of(contour, [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d x = apex + metre_per_pixel * ((p.x() - 319.5) * lateral + (p.y() - 8.0) * axial);
    return wall.distance(x) * 1e3;  // [mm]
  });
  EXPECT_GT(errors.count, 0.6 * static_cast<double>(contour.size()));
  EXPECT_LT(std::abs(errors.mean), 0.3);
  EXPECT_LT(errors.deviation, 0.6);
}

}  // namespace
}  // namespace tissue_stiffness
