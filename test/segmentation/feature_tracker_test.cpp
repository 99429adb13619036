// Features are followed through images that are moved in a known way.
#include "segmentation/feature_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "segmentation/texture_window.hpp"
#include "synthetic_images.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

const cv::Size kSize(320, 240);

FeatureSettings texture_settings(int most = 60) {
  FeatureSettings out;
  out.most = most;
  return out;
}

// A texture that a camera sees moved: pixel p of the first image is at `motion` p + shift. Contrast and brightness change.
class MovedTexture {
 public:
  MovedTexture() : pattern_(texture({640, 480}, 120.0, 25.0, 2.5, 3)) {}

  cv::Mat seen(const cv::Matx23d& motion, double noise, unsigned seed, double contrast = 1.0,
               double brightness = 0.0) const {
    const cv::Matx23d shifted(motion(0, 0), motion(0, 1), motion(0, 2) - 160.0 * motion(0, 0) - 120.0 * motion(0, 1),
                              motion(1, 0), motion(1, 1), motion(1, 2) - 160.0 * motion(1, 0) - 120.0 * motion(1, 1));
    cv::Mat image, grain(kSize, CV_32F), out;
    cv::warpAffine(pattern_, image, shifted, kSize, cv::INTER_CUBIC, cv::BORDER_REFLECT);
    cv::RNG random(seed);
    random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
    image = contrast * image + brightness + grain;
    image.convertTo(out, CV_8U);
    return out;
  }

 private:
  cv::Mat pattern_;
};

cv::Matx23d motion_at(double time) {
  const double angle = 0.12 * std::sin(time), stretch = 1.0 + 0.08 * std::sin(0.7 * time);
  const double c = std::cos(angle), s = std::sin(angle);
  // About the middle of the image, so that most features stay in it.
  const cv::Matx22d turn(stretch * c, -s, s, c / stretch);
  const cv::Vec2d middle(160.0, 120.0),
      shift = middle - turn * middle + cv::Vec2d(9.0 * std::sin(time), 5.0 * std::sin(2.0 * time));
  return {turn(0, 0), turn(0, 1), shift[0], turn(1, 0), turn(1, 1), shift[1]};
}

Eigen::Vector2d moved(const cv::Matx23d& m, const Eigen::Vector2d& p) {
  return {m(0, 0) * p.x() + m(0, 1) * p.y() + m(0, 2), m(1, 0) * p.x() + m(1, 1) * p.y() + m(1, 2)};
}

// The errors are as large as stated, and they do not grow from image to image.
TEST(TextureTracker, FollowsATextureThatTurnsAndStretches) {
  const MovedTexture film;
  const std::unique_ptr<FeatureTracker> tracker = make_feature_tracker(texture_settings());
  double square = 0.0, square_late = 0.0, normalised = 0.0, count = 0.0, late = 0.0;
  for (int k = 0; k < 40; ++k) {
    const cv::Matx23d motion = motion_at(0.15 * k);
    const TrackedFeatures found = tracker->track(film.seen(motion, 8.0, static_cast<unsigned>(k) + 1), 0.1 * k);
    ASSERT_TRUE(found.found()) << k << ": " << found.reason;
    ASSERT_GE(found.tracks.size(), 30) << k;
    EXPECT_DOUBLE_EQ(found.tracks.stamp, 0.1 * k);
    for (Eigen::Index i = 0; i < found.tracks.size() && k > 0; ++i) {
      const Eigen::Vector2d error = found.tracks.pixels.col(i) - moved(motion, found.tracks.reference.col(i));
      square += error.squaredNorm();
      normalised += error.squaredNorm() / std::pow(found.tracks.sigma[i], 2);
      count += 2.0;
      if (k < 30) continue;
      square_late += error.squaredNorm();
      late += 2.0;
    }
  }
  const double rms = std::sqrt(square / count);
  EXPECT_LT(rms, 0.1);
  EXPECT_NEAR(std::sqrt(square_late / late), rms, 0.3 * rms);
  EXPECT_GT(normalised / count, 0.6);
  EXPECT_LT(normalised / count, 1.3);
}

TEST(TextureTracker, IgnoresBrightnessAndContrast) {
  const MovedTexture film;
  const std::unique_ptr<FeatureTracker> tracker = make_feature_tracker(texture_settings());
  tracker->track(film.seen(motion_at(0.0), 2.0, 1), 0.0);
  const cv::Matx23d motion = motion_at(0.3);
  const TrackedFeatures found = tracker->track(film.seen(motion, 2.0, 2, 0.8, 30.0), 0.1);
  ASSERT_GE(found.tracks.size(), 30) << found.reason;
  double square = 0.0;
  for (Eigen::Index i = 0; i < found.tracks.size(); ++i)
    square += (found.tracks.pixels.col(i) - moved(motion, found.tracks.reference.col(i))).squaredNorm();
  EXPECT_LT(std::sqrt(square / (2.0 * static_cast<double>(found.tracks.size()))), 0.15);
}

// A tool covers the left half for a while. What it covers comes back with its numbers.
TEST(TextureTracker, FindsFeaturesAgainThatWereCovered) {
  const MovedTexture film;
  const std::unique_ptr<FeatureTracker> tracker = make_feature_tracker(texture_settings());
  const cv::Mat image = film.seen(motion_at(0.0), 2.0, 1);
  const Eigen::Index all = tracker->track(image, 0.0).tracks.size();
  cv::Mat covered = image.clone();
  cv::rectangle(covered, cv::Rect(0, 0, 160, 240), cv::Scalar(220), cv::FILLED);
  const TrackedFeatures half = tracker->track(covered, 0.1);
  ASSERT_TRUE(half.found()) << half.reason;
  EXPECT_LT(half.tracks.size(), 0.7 * static_cast<double>(all));
  EXPECT_GT(half.tracks.reference.row(0).minCoeff(), 150.0);
  EXPECT_EQ(tracker->track(image, 0.2).tracks.size(), all);
}

TEST(TextureTracker, StartsAnewAfterAReset) {
  const MovedTexture film;
  const std::unique_ptr<FeatureTracker> tracker = make_feature_tracker(texture_settings());
  tracker->track(film.seen(motion_at(0.0), 2.0, 1), 0.0);
  tracker->reset();
  const TrackedFeatures found = tracker->track(film.seen(motion_at(0.3), 2.0, 2), 0.1);
  ASSERT_TRUE(found.found());
  EXPECT_LT((found.tracks.pixels - found.tracks.reference).cwiseAbs().maxCoeff(), 0.01);
}

TEST(TextureTracker, SaysWhyThereIsNothing) {
  const std::unique_ptr<FeatureTracker> tracker = make_feature_tracker(texture_settings());
  const cv::Mat plain = camera_image(cv::Mat(kSize, CV_32F, cv::Scalar(120)), cv::Mat(kSize, CV_32F, cv::Scalar(120)),
                                     cv::Mat::zeros(kSize, CV_32F), 1.0, 3.0, 1);
  EXPECT_NE(tracker->track(plain, 0.0).reason.find("corners of a texture"), std::string::npos);
  const MovedTexture film;
  EXPECT_TRUE(tracker->track(film.seen(motion_at(0.0), 2.0, 1), 0.1).found()) << "the first image with a texture";
  const TrackedFeatures lost = tracker->track(plain, 0.2);
  EXPECT_FALSE(lost.found());
  EXPECT_NE(lost.reason.find("features; allowed: 8 or more"), std::string::npos) << lost.reason;
  EXPECT_THROW(tracker->track(cv::Mat(100, 100, CV_8UC1, cv::Scalar(0)), 0.3), InputError);
  EXPECT_THROW(tracker->track(cv::Mat(), 0.3), InputError);
}

TEST(TextureTracker, ChoosesFeaturesInTheRegionOfInterest) {
  FeatureSettings settings = texture_settings();
  settings.roi = PixelBox{100, 60, 120, 100};
  const TrackedFeatures found = make_feature_tracker(settings)->track(MovedTexture().seen(motion_at(0.0), 2.0, 1), 0.0);
  ASSERT_TRUE(found.found());
  EXPECT_GE(found.tracks.reference.row(0).minCoeff(), 100.0);
  EXPECT_LT(found.tracks.reference.row(0).maxCoeff(), 220.0);
  EXPECT_GE(found.tracks.reference.row(1).minCoeff(), 60.0);
  EXPECT_LT(found.tracks.reference.row(1).maxCoeff(), 160.0);
}

// The noise in an image without texture tells no place, however strong its gradients are.
TEST(TextureWindow, TakesNoInformationFromNoise) {
  cv::Mat noise(kSize, CV_32F), image;
  cv::RNG random(5);
  random.fill(noise, cv::RNG::NORMAL, 120.0, 6.0);
  noise.convertTo(image, CV_8U);
  EXPECT_NEAR(image_noise(image), 6.0, 0.3);
  EXPECT_GT(TextureWindow(smooth_image(image), {160, 120}).sigma(6.0), 0.5);
  const cv::Mat film = MovedTexture().seen(motion_at(0.0), 6.0, 1);
  EXPECT_NEAR(image_noise(film), 6.0, 1.0);
  EXPECT_LT(TextureWindow(smooth_image(film), {160, 120}).sigma(6.0), 0.2);
}

// Two tags on a plane that is turned in space.
TEST(TagTracker, FollowsTheCornersOfTags) {
  FeatureSettings settings;
  settings.kind = FeatureSettings::Kind::tags;
  settings.dictionary = cv::aruco::DICT_APRILTAG_36h11;
  const cv::Ptr<cv::aruco::Dictionary> dictionary = cv::aruco::getPredefinedDictionary(settings.dictionary);
  const auto drawn = [&](const cv::Matx33d& view, const std::vector<int>& tags) {
    cv::Mat plane(960, 1280, CV_8UC1, cv::Scalar(230)), image;
    for (const int tag : tags) {
      cv::Mat marker;
      cv::aruco::drawMarker(dictionary, tag, 240, marker, 1);
      marker.copyTo(plane(cv::Rect(240 + 480 * (tag % 2), 320, 240, 240)));
    }
    cv::GaussianBlur(plane, plane, {}, 2.0);  // or the small image has steps
    cv::warpPerspective(plane, image, view, kSize, cv::INTER_AREA, cv::BORDER_REPLICATE);
    cv::GaussianBlur(image, image, {}, 0.7);
    return image;
  };
  const cv::Matx33d still(0.25, 0, 0, 0, 0.25, 0, 0, 0, 1), turned(0.24, 0.02, 6, -0.03, 0.25, 12, 2e-5, -1e-5, 1);
  const std::unique_ptr<FeatureTracker> tracker = make_feature_tracker(settings);
  EXPECT_EQ(tracker->track(drawn(still, {}), 0.0).reason, "no tag of the dictionary");
  const TrackedFeatures first = tracker->track(drawn(still, {4, 7}), 0.1);
  ASSERT_EQ(first.tracks.size(), 8);
  EXPECT_EQ(first.tracks.ids[0], 16);
  EXPECT_EQ(first.tracks.ids[7], 31);
  const TrackedFeatures found = tracker->track(drawn(turned, {4, 7}), 0.2);
  ASSERT_EQ(found.tracks.size(), 8);
  const cv::Matx33d between = turned * still.inv();
  for (Eigen::Index i = 0; i < 8; ++i) {
    const cv::Vec3d p = between * cv::Vec3d(found.tracks.reference(0, i), found.tracks.reference(1, i), 1.0);
    EXPECT_NEAR(found.tracks.pixels(0, i), p[0] / p[2], 0.5) << i;
    EXPECT_NEAR(found.tracks.pixels(1, i), p[1] / p[2], 0.5) << i;
  }
  const TrackedFeatures other = tracker->track(drawn(still, {8, 9}), 0.3);
  EXPECT_EQ(other.reason, "no tag that the first image with tags shows, too");
}

}  // namespace
}  // namespace tissue_stiffness
