#include "segmentation/area_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

/// Finds a circle whose radius is given, and counts how often its memory was cleared.
class Circle : public Segmenter {
 public:
  explicit Circle(int& resets) : resets_(resets) {}
  Segmentation segment(const cv::Mat& image, double stamp) override {
    const double radius = image.at<double>(0);
    if (radius == 0.0) return {{}, "nothing"};
    Segmentation found;
    found.contour.stamp = stamp;
    found.contour.points.resize(2, 60);
    for (int i = 0; i < 60; ++i)
      found.contour.points.col(i) << radius * std::cos(0.1047 * i), radius * std::sin(0.1047 * i);
    return found;
  }
  void reset() override { ++resets_; }

 private:
  int& resets_;
};

class AreaWatchTest : public ::testing::Test {
 protected:
  Segmentation show(double radius) { return watch_.segment(cv::Mat(1, 1, CV_64F, cv::Scalar(radius)), ++time_); }
  bool accepts(double radius) { return show(radius).found(); }

  int resets_ = 0;
  double time_ = 0.0;
  AreaWatch watch_{std::make_unique<Circle>(resets_)};
};

TEST_F(AreaWatchTest, AreasThatChangeSlowlyPass) {
  for (int k = 0; k < 30; ++k) EXPECT_TRUE(accepts(50.0 * std::pow(1.02, k))) << k;
  EXPECT_EQ(resets_, 0);
}

TEST_F(AreaWatchTest, OneJumpIsRefusedAndNotRemembered) {
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(accepts(50.0));
  for (const double radius : {80.0, 30.0}) {
    const Segmentation found = show(radius);
    EXPECT_FALSE(found.found());
    EXPECT_NE(found.reason.find(radius > 50.0 ? "jumps to 2.56 times" : "jumps to 0.36 times"), std::string::npos)
        << found.reason;
  }
  EXPECT_EQ(resets_, 2) << "the wrong outline must not lead the search";
  EXPECT_TRUE(accepts(50.5));
}

TEST_F(AreaWatchTest, ThirtyThatAgreeAreBelievedAgain) {
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(accepts(50.0));
  for (int k = 1; k < 30; ++k) EXPECT_FALSE(accepts(k % 2 == 0 ? 80.0 : 81.0)) << k;
  EXPECT_FALSE(show(0.0).found());
  EXPECT_TRUE(accepts(80.0));
  EXPECT_TRUE(accepts(82.0));
  EXPECT_FALSE(accepts(50.0));
}

TEST_F(AreaWatchTest, ThirtyThatDisagreeAreNot) {
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(accepts(50.0));
  for (int k = 0; k < 90; ++k) EXPECT_FALSE(accepts(k % 3 == 0 ? 80.0 : k % 3 == 1 ? 100.0 : 30.0)) << k;
}

TEST_F(AreaWatchTest, ResetForgets) {
  EXPECT_TRUE(accepts(50.0));
  watch_.reset();
  EXPECT_TRUE(accepts(100.0));
}

}  // namespace
}  // namespace tissue_stiffness
