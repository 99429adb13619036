#include "segmentation/overlay.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "segmentation/outline.hpp"

namespace tissue_stiffness {
namespace {

const cv::Scalar seen(80, 255, 80), unseen(70, 110, 70), model(255, 80, 255);  // BGR
constexpr int shift = 4;               // fractional bits of OpenCV's drawing coordinates
constexpr double longest_join = 12.0;  // [pixel]

cv::Point fixed_point(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x() * (1 << shift))), static_cast<int>(std::lround(p.y() * (1 << shift)))};
}

void join(cv::Mat* canvas, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour) {
  cv::line(*canvas, fixed_point(a), fixed_point(b), colour, 1, cv::LINE_AA, shift);
}

}  // namespace

cv::Mat draw_overlay(const cv::Mat& image, const Contour& measured, const Eigen::Matrix2Xd& predicted) {
  cv::Mat canvas;
  if (image.type() == CV_8UC3) {
    canvas = image.clone();
  } else {
    cv::Mat grey;
    to_grey(image).convertTo(grey, CV_8U);
    cv::cvtColor(grey, canvas, cv::COLOR_GRAY2BGR);
  }
  const Eigen::Index n = measured.size(), m = predicted.cols();
  for (Eigen::Index i = 0; i < (measured.closed ? n : n - 1); ++i) {
    const Eigen::Index j = (i + 1) % n;
    const bool both = std::isfinite(measured.sigma(i)) && std::isfinite(measured.sigma(j));
    join(&canvas, measured.points.col(i), measured.points.col(j), both ? seen : unseen);
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Vector2d a = predicted.col(i), b = predicted.col((i + 1) % m);
    if (!a.allFinite()) continue;
    const bool near = b.allFinite() && (b - a).norm() < longest_join;
    join(&canvas, a, near ? b : a, model);
  }
  return canvas;
}

}  // namespace tissue_stiffness
