#include "segmentation/overlay.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

Contour square() {
  Contour contour;
  contour.points.resize(2, 4);
  contour.points << 10, 30, 30, 10, 10, 10, 30, 30;
  contour.normals = Eigen::Matrix2Xd::Zero(2, 4);
  contour.sigma = Eigen::VectorXd::Constant(4, 0.1);
  return contour;
}

TEST(overlay, draws_seen_unseen_and_predicted_in_their_colours) {
  const cv::Mat image(40, 40, CV_8U, cv::Scalar(50));
  Contour contour = square();
  contour.sigma(3) = std::numeric_limits<double>::infinity();
  Eigen::Matrix2Xd predicted(2, 3);
  predicted << 15, 20, 20, 20, 20, 24;
  const cv::Mat drawn = draw_overlay(image, contour, predicted);
  ASSERT_EQ(drawn.type(), CV_8UC3);
  const cv::Vec3b top = drawn.at<cv::Vec3b>(10, 20), left = drawn.at<cv::Vec3b>(20, 10),
                  model = drawn.at<cv::Vec3b>(20, 17);
  EXPECT_GT(top[1], 200);
  EXPECT_LT(left[1], top[1] - 50);
  EXPECT_GT(left[1], left[2] + 20);
  EXPECT_GT(model[2], 200);
  EXPECT_LT(model[1], 120);
  EXPECT_EQ(drawn.at<cv::Vec3b>(35, 35), cv::Vec3b(50, 50, 50));
  EXPECT_EQ(cv::countNonZero(image != 50), 0) << "the input must stay as it is";
}

TEST(overlay, nothing_measured_nothing_predicted) {
  const cv::Mat image(40, 40, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat drawn = draw_overlay(image, Contour(), Eigen::Matrix2Xd(2, 0));
  EXPECT_EQ(cv::norm(drawn, image), 0.0);
  EXPECT_THROW(draw_overlay(cv::Mat::zeros(4, 4, CV_32F), Contour(), Eigen::Matrix2Xd(2, 0)), InputError);
}

TEST(overlay, predicted_points_that_are_not_finite_are_left_out) {
  const cv::Mat image(40, 40, CV_8U, cv::Scalar(0));
  const Eigen::Matrix2Xd predicted = Eigen::Matrix2Xd::Constant(2, 3, std::numeric_limits<double>::quiet_NaN());
  const cv::Mat drawn = draw_overlay(image, Contour(), predicted);
  EXPECT_EQ(cv::norm(drawn), 0.0);
}

}  // namespace
}  // namespace tissue_stiffness
