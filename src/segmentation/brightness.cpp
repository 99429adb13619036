#include "segmentation/brightness.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace tissue_stiffness {
namespace {

constexpr double kSmallestBody = 0.003;  // of the image, as for the silhouette
constexpr double kMostOfBorder = 0.75;   // of texture alone, half the border is on either side

cv::Mat border_mask(const cv::Size& size) {
  const int width = std::max(1, std::min(size.width, size.height) / 50);
  cv::Mat mask(size, CV_8U, cv::Scalar(255));
  mask(cv::Rect(width, width, size.width - 2 * width, size.height - 2 * width)).setTo(0);
  return mask;
}

}  // namespace

bool shows_dark_body(const cv::Mat& image) {
  cv::Mat grey, bright;
  if (image.channels() == 3) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = image;
  }
  cv::GaussianBlur(grey, grey, {}, 1.5);
  cv::threshold(grey, bright, 0.0, 255.0, cv::THRESH_BINARY | cv::THRESH_OTSU);
  const double share = cv::countNonZero(bright) / static_cast<double>(grey.total());
  if (share > 1.0 - kSmallestBody || share < kSmallestBody) return false;
  return cv::mean(bright, border_mask(grey.size()))[0] > 255.0 * kMostOfBorder;
}

}  // namespace tissue_stiffness
