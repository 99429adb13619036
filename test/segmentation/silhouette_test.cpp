#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "synthetic_images.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

const cv::Size size(400, 320);

std::unique_ptr<Segmenter> silhouette() {
  return make_segmenter({SegmentationSettings::Kind::silhouette, {}});
}

cv::Mat disc(const Eigen::Vector2d& centre, double radius, unsigned seed) {
  const auto inside = [&](double u, double v) { return std::hypot(u - centre.x(), v - centre.y()) < radius; };
  cv::Mat body = texture(size, 150.0, 6.0, 6.0, seed);
  for (int u = 0; u < size.width; ++u) body.col(u) += 0.2 * (centre.x() - u);  // lit from the left
  return camera_image(body, texture(size, 55.0, 10.0, 15.0, seed + 1), coverage(size, inside), 0.9, 3.0, seed + 2);
}

std::function<double(const Eigen::Vector2d&)> to_circle(const Eigen::Vector2d& centre, double radius) {
  return [=](const Eigen::Vector2d& p) { return (p - centre).norm() - radius; };
}

TEST(silhouette, disc_without_bias_and_with_honest_sigma) {
  const Eigen::Vector2d centre(201.37, 158.81);
  double nis = 0.0, mean = 0.0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Segmentation found = silhouette()->segment(disc(centre, 70.3, 10 * seed), 1.5);
    ASSERT_TRUE(found.found()) << found.reason;
    EXPECT_EQ(found.contour.stamp, 1.5);
    EXPECT_EQ(found.contour.width, size.width);
    EXPECT_EQ(found.contour.height, size.height);
    const Errors errors = errors_of(found.contour, to_circle(centre, 70.3));
    EXPECT_GT(errors.count, 0.95 * static_cast<double>(found.contour.size()));
    EXPECT_LT(errors.deviation, 0.15);
    EXPECT_LT(errors.worst, 0.8);
    mean += errors.mean / 5.0;
    nis += errors.nis / 5.0;
  }
  EXPECT_NEAR(mean, 0.0, 0.03);
  EXPECT_GT(nis, 0.4);
  EXPECT_LT(nis, 1.6);
}

TEST(silhouette, points_are_ordered_even_and_normals_point_out) {
  const Eigen::Vector2d centre(200.0, 160.0);
  const Contour contour = silhouette()->segment(disc(centre, 60.0, 3), 0.0).contour;
  ASSERT_FALSE(contour.empty());
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const double gap = (contour.points.col((i + 1) % contour.size()) - contour.points.col(i)).norm();
    EXPECT_GT(gap, 2.0);
    EXPECT_LT(gap, 3.2);
    EXPECT_NEAR(contour.normals.col(i).norm(), 1.0, 1e-12);
    EXPECT_GT(contour.normals.col(i).dot((contour.points.col(i) - centre).normalized()), 0.95);
  }
}

TEST(silhouette, rectangle_edges) {
  const Eigen::Vector2d low(61.3, 120.6), high(338.8, 177.4);
  const auto inside = [&](double u, double v) { return u > low.x() && u < high.x() && v > low.y() && v < high.y(); };
  const cv::Mat image = camera_image(texture(size, 130.0, 5.0, 5.0, 5), texture(size, 55.0, 12.0, 12.0, 6),
                                     coverage(size, inside), 1.0, 3.0, 7);
  const Contour contour = silhouette()->segment(image, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  double top = 0.0, bottom = 0.0;
  int tops = 0, bottoms = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2d p = contour.points.col(i);
    if (p.x() < low.x() + 8.0 || p.x() > high.x() - 8.0 || !std::isfinite(contour.sigma(i))) continue;
    const bool upper = p.y() < 150.0;
    (upper ? top : bottom) += p.y() - (upper ? low.y() : high.y());
    ++(upper ? tops : bottoms);
  }
  EXPECT_GT(tops, 80);
  EXPECT_GT(bottoms, 80);
  EXPECT_NEAR(top / tops, 0.0, 0.05);
  EXPECT_NEAR(bottom / bottoms, 0.0, 0.05);
}

// A terminator darkens the lower half nearly to the background's grey: no threshold holds the whole body together.
TEST(silhouette, dark_side_is_part_of_the_body) {
  const Eigen::Vector2d centre(200.4, 150.2);
  cv::Mat body = texture(size, 150.0, 3.0, 6.0, 21);
  for (int v = 0; v < size.height; ++v) {
    const double depth = std::clamp((v - centre.y()) / 25.0, 0.0, 1.0);
    body.row(v) -= 72.0 * depth * depth * (3.0 - 2.0 * depth);
  }
  const auto inside = [&](double u, double v) { return std::hypot(u - centre.x(), v - centre.y()) < 75.0; };
  const cv::Mat image = camera_image(body, texture(size, 48.0, 4.0, 15.0, 22), coverage(size, inside), 1.0, 3.0, 23);
  const Contour contour = silhouette()->segment(image, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  const Errors errors = errors_of(contour, to_circle(centre, 75.0));
  EXPECT_GT(errors.count, 0.8 * static_cast<double>(contour.size()));
  EXPECT_NEAR(errors.mean, 0.0, 0.1);
  EXPECT_LT(errors.worst, 1.5);
}

// In contact the body's underside has the floor's grey: no edge there, and no leak along the floor.
TEST(silhouette, floor_contact_has_infinite_sigma_and_does_not_leak) {
  const Eigen::Vector2d centre(200.0, 150.0);
  const double floor = 215.0;
  const auto inside = [&](double u, double v) { return std::hypot(u - centre.x(), v - centre.y()) < 75.0 && v < floor; };
  cv::Mat body = texture(size, 150.0, 3.0, 6.0, 31), background = texture(size, 50.0, 5.0, 15.0, 32);
  for (int v = 0; v < size.height; ++v) {
    body.row(v) -= 65.0 * std::clamp((v - centre.y()) / 60.0, 0.0, 1.0);
    if (v >= floor) background.row(v) += 35.0;
  }
  const cv::Mat image = camera_image(body, background, coverage(size, inside), 1.0, 3.0, 33);
  const Contour contour = silhouette()->segment(image, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  int contact = 0, trusted = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2d p = contour.points.col(i);
    EXPECT_LT(p.y(), floor + 6.0);
    EXPECT_LT((p - centre).norm(), 78.0);
    if (p.y() < 190.0 || std::abs(p.x() - centre.x()) > 25.0) continue;
    ++contact;
    trusted += std::isfinite(contour.sigma(i));
  }
  EXPECT_GT(contact, 10);
  EXPECT_LT(trusted, contact / 3);
}

TEST(silhouette, follows_motion_through_an_empty_frame) {
  const auto segmenter = silhouette();
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector2d centre(120.0 + 15.0 * k, 120.0 + 9.0 * k);
    if (k == 4) {
      const Segmentation none = segmenter->segment(cv::Mat(size, CV_8U, cv::Scalar(80)), k);
      EXPECT_FALSE(none.found());
      EXPECT_FALSE(none.reason.empty());
      continue;
    }
    const Segmentation found = segmenter->segment(disc(centre, 50.0, 100 + static_cast<unsigned>(k)), k);
    ASSERT_TRUE(found.found()) << found.reason;
    EXPECT_LT(std::abs(errors_of(found.contour, to_circle(centre, 50.0)).mean), 0.1) << "frame " << k;
  }
}

TEST(silhouette, nothing_to_find) {
  const auto segmenter = silhouette();
  for (const cv::Size tiny : {cv::Size(1, 1), cv::Size(7, 300), cv::Size(31, 31)}) {
    EXPECT_FALSE(segmenter->segment(cv::Mat(tiny, CV_8U, cv::Scalar(90)), 0.0).found());
  }
  for (const int grey : {0, 128, 255}) {
    const Segmentation found = segmenter->segment(cv::Mat(size, CV_8U, cv::Scalar(grey)), 0.0);
    EXPECT_TRUE(found.contour.empty());
    EXPECT_FALSE(found.reason.empty());
  }
  for (unsigned seed = 0; seed < 5; ++seed) {
    const cv::Mat flat = texture(size, 80.0, 0.0, 3.0, seed), empty = cv::Mat::zeros(size, CV_32F);
    EXPECT_FALSE(segmenter->segment(camera_image(flat, flat, empty, 0.7, 20.0, seed), 0.0).found());
    EXPECT_FALSE(
        segmenter->segment(camera_image(flat, texture(size, 60.0, 15.0, 20.0, seed), empty, 0.7, 3.0, seed), 0.0).found());
  }
}

TEST(silhouette, seed_chooses_between_two_bodies) {
  const auto inside = [&](double u, double v) {
    return std::hypot(u - 100.0, v - 160.0) < 50.0 || std::hypot(u - 300.0, v - 160.0) < 50.0;
  };
  const cv::Mat image = camera_image(texture(size, 140.0, 3.0, 5.0, 1), texture(size, 50.0, 5.0, 15.0, 2),
                                     coverage(size, inside), 1.0, 3.0, 3);
  for (const double u : {100.0, 300.0}) {
    const auto segmenter = make_segmenter({SegmentationSettings::Kind::silhouette, Eigen::Vector2d(u, 160.0)});
    const Contour contour = segmenter->segment(image, 0.0).contour;
    ASSERT_FALSE(contour.empty());
    EXPECT_NEAR(contour.points.row(0).mean(), u, 1.0);
  }
}

TEST(silhouette, two_bodies_alike_are_refused_without_a_seed) {
  const auto inside = [&](double u, double v) {
    return std::hypot(u - 100.0, v - 160.0) < 50.0 || std::hypot(u - 300.0, v - 160.0) < 48.0;
  };
  const cv::Mat image = camera_image(texture(size, 140.0, 3.0, 5.0, 1), texture(size, 50.0, 5.0, 15.0, 2),
                                     coverage(size, inside), 1.0, 3.0, 3);
  const Segmentation found = silhouette()->segment(image, 0.0);
  EXPECT_FALSE(found.found());
  EXPECT_NE(found.reason.find("two regions are alike"), std::string::npos) << found.reason;
  const auto segmenter = silhouette();  // which has seen one of them alone
  ASSERT_TRUE(segmenter->segment(disc({100.0, 160.0}, 50.0, 4), 0.0).found());
  const Segmentation next = segmenter->segment(image, 1.0);
  ASSERT_TRUE(next.found()) << next.reason;
  EXPECT_NEAR(next.contour.points.row(0).mean(), 100.0, 1.0);
}

TEST(silhouette, dark_body_is_found_as_well_as_a_bright_one) {
  SegmentationSettings settings;
  settings.body = SegmentationSettings::Body::dark;
  const Eigen::Vector2d centre(201.37, 158.81);
  cv::Mat inverted;
  cv::bitwise_not(disc(centre, 70.3, 10), inverted);
  const Segmentation dark = make_segmenter(settings)->segment(inverted, 0.0);
  const Segmentation bright = silhouette()->segment(disc(centre, 70.3, 10), 0.0);
  ASSERT_TRUE(dark.found()) << dark.reason;
  ASSERT_EQ(dark.contour.size(), bright.contour.size());
  EXPECT_LT((dark.contour.points - bright.contour.points).cwiseAbs().maxCoeff(), 1e-6);
}

/// A disc and its surroundings in two colours (red, green, blue), before a white window in the upper right corner.
cv::Mat coloured(const Eigen::Vector2d& centre, double radius, const Eigen::Vector3d& body, const Eigen::Vector3d& around) {
  const auto inside = [&](double u, double v) { return std::hypot(u - centre.x(), v - centre.y()) < radius; };
  const cv::Mat cover = coverage(size, inside);
  std::vector<cv::Mat> channels;
  for (const int k : {2, 1, 0}) {
    const unsigned seed = 10U * static_cast<unsigned>(k);
    cv::Mat shaded = texture(size, body[k], 3.0, 6.0, seed), background = texture(size, around[k], 8.0, 15.0, 7);
    for (int u = 0; u < size.width; ++u) shaded.col(u) *= 1.0 + 0.2 * (centre.x() - u) / radius;
    background(cv::Rect(300, 15, 80, 100)) = 250.0;
    channels.push_back(camera_image(shaded, background, cover, 0.9, 3.0, seed + 1));
  }
  cv::Mat image;
  cv::merge(channels, image);
  return image;
}

TEST(silhouette, coloured_body_before_a_window_of_any_brightness) {
  const Eigen::Vector2d centre(180.3, 170.6);
  const Eigen::Vector3d purple(112, 48, 150);
  SegmentationSettings settings;
  settings.body = SegmentationSettings::Body::colour;
  settings.colour = {120, 60, 160};
  settings.tolerance = 25.0;
  for (const double grey : {60.0, 85.0, 150.0}) {
    const cv::Mat image = coloured(centre, 62.4, purple, {grey, grey, grey});
    const Segmentation found = make_segmenter(settings)->segment(image, 0.0);
    ASSERT_TRUE(found.found()) << found.reason << " before " << grey;
    const Errors errors = errors_of(found.contour, to_circle(centre, 62.4));
    EXPECT_NEAR(errors.mean, 0.0, 0.25) << "before " << grey;
    EXPECT_LT(errors.nis, 1.6) << "before " << grey;
    EXPECT_LT(errors.deviation, 0.3) << "before " << grey;
    EXPECT_GT(errors.count, 0.8 * static_cast<double>(found.contour.size()));
  }
  const Segmentation other = make_segmenter(settings)->segment(coloured(centre, 62.4, {60, 140, 60}, {85, 85, 85}), 0.0);
  EXPECT_FALSE(other.found()) << "a green body is not the purple one";
}

TEST(silhouette, colour_needs_a_hue_and_a_coloured_image) {
  SegmentationSettings settings;
  settings.body = SegmentationSettings::Body::colour;
  settings.tolerance = 25.0;
  settings.colour = {120, 124, 120};
  EXPECT_THROW(make_segmenter(settings), InputError);
  settings.colour = {120, 60, 160};
  EXPECT_THROW(make_segmenter(settings)->segment(disc({200.0, 160.0}, 60.0, 8), 0.0), InputError);
}

TEST(silhouette, colour_equals_grey_and_results_repeat) {
  const cv::Mat grey = disc({200.0, 160.0}, 60.0, 8);
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  const auto segmenter = silhouette();
  const Contour first = segmenter->segment(grey, 0.0).contour;
  segmenter->reset();
  const Contour second = segmenter->segment(colour, 0.0).contour;
  ASSERT_EQ(first.size(), second.size());
  EXPECT_TRUE(first.points == second.points);
  EXPECT_TRUE(first.sigma == second.sigma);
}

TEST(silhouette, wrong_images_are_input_errors) {
  const auto segmenter = silhouette();
  EXPECT_THROW(segmenter->segment(cv::Mat(), 0.0), InputError);
  EXPECT_THROW(segmenter->segment(cv::Mat::zeros(size, CV_16U), 0.0), InputError);
  EXPECT_THROW(segmenter->segment(cv::Mat::zeros(size, CV_8UC4), 0.0), InputError);
}

// A rendered foam ball, 30 mm radius seen from 1 m with 2500 pixels focal length, before it touches the floor.
TEST(silhouette, rendered_ball_is_a_circle) {
  const cv::Mat image = cv::imread(TISSUE_STIFFNESS_TEST_DATA "/segmentation/ball.png", cv::IMREAD_UNCHANGED);
  ASSERT_FALSE(image.empty());
  const Contour contour = silhouette()->segment(image, 0.0).contour;
  ASSERT_FALSE(contour.empty());
  const Eigen::Vector2d centre(319.4 - 170.0, 324.1 - 190.0);
  const double radius = 2500.0 * 0.03 / std::sqrt(1.0 - 0.03 * 0.03);
  const Errors errors = errors_of(contour, to_circle(centre, radius));
  EXPECT_GT(errors.count, 0.9 * static_cast<double>(contour.size()));
  EXPECT_LT(std::abs(errors.mean), 0.3);
  EXPECT_LT(errors.deviation, 0.35);
  EXPECT_LT(errors.worst, 2.0);
}

}  // namespace
}  // namespace tissue_stiffness
