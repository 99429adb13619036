#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "segmentation/outline.hpp"
#include "segmentation/silhouette.hpp"

namespace tissue_stiffness {
namespace {

constexpr int working_width = 320;  // [pixel] the search needs no more resolution
constexpr int thresholds = 24;
constexpr double rival_score = 0.8;                          // of the best: as sharp
constexpr double rival_area = 0.5;                           // of the larger: as large
constexpr double smallest_area = 0.003, largest_area = 0.8;  // of the image

using Border = std::vector<cv::Point>;

/// Returns the mean gradient along the border; pixels at the image's edge count as zero.
double border_gradient(const Border& border, const cv::Mat& gradient) {
  double sum = 0.0;
  for (const cv::Point& p : border) {
    const bool at_edge = p.x < 2 || p.y < 2 || p.x >= gradient.cols - 2 || p.y >= gradient.rows - 2;
    if (!at_edge) sum += gradient.at<float>(p);
  }
  return sum / static_cast<double>(border.size());
}

/// Returns the shared area of a border's inside and a mask over their joint area.
double overlap(const Border& border, const cv::Mat& mask) {
  cv::Mat inside = cv::Mat::zeros(mask.size(), CV_8U);
  cv::fillPoly(inside, std::vector<Border>{border}, 255);
  return cv::countNonZero(inside & mask) / std::max(1.0, static_cast<double>(cv::countNonZero(inside | mask)));
}

cv::Mat mask_of(const Eigen::Matrix2Xd& outline, double scale, cv::Size size) {
  Border border;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    border.emplace_back(cvRound((outline(0, i) + 0.5) * scale - 0.5), cvRound((outline(1, i) + 0.5) * scale - 0.5));
  }
  cv::Mat mask = cv::Mat::zeros(size, CV_8U);
  if (!border.empty()) cv::fillPoly(mask, std::vector<Border>{border}, 255);
  return mask;
}

cv::Mat gradient_magnitude(const cv::Mat& image) {
  cv::Mat du, dv, magnitude;
  cv::Sobel(image, du, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(image, dv, CV_32F, 0, 1, 3, 0.125);
  cv::magnitude(du, dv, magnitude);
  return magnitude;
}

struct Candidate {
  Border border;
  double area = 0.0, score = 0.0;
};

bool is_rival(const Candidate& other, const Candidate& best) {
  const double smaller = std::min(other.area, best.area), larger = std::max(other.area, best.area);
  const bool apart = (cv::boundingRect(other.border) & cv::boundingRect(best.border)).empty();
  return apart && other.score > rival_score * best.score && smaller > rival_area * larger;
}

}  // namespace

BrightRegion sharpest_region(const cv::Mat& grey, const std::optional<Eigen::Vector2d>& seed,
                             const Eigen::Matrix2Xd& previous, double least) {
  const double scale = std::min(1.0, static_cast<double>(working_width) / grey.cols);
  cv::Mat small;
  cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  cv::GaussianBlur(small, small, {}, 1.5);
  const cv::Mat gradient = gradient_magnitude(small), before = mask_of(previous, scale, small.size());
  double lowest = 0.0, highest = 0.0;
  cv::minMaxLoc(small, &lowest, &highest);
  lowest = std::max(lowest, least);

  std::vector<Candidate> candidates;
  for (int k = 1; k < thresholds && lowest < highest; ++k) {
    cv::Mat mask = small > lowest + (highest - lowest) * k / thresholds;
    std::vector<Border> borders;
    cv::findContours(mask, borders, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    for (Border& border : borders) {
      const double area = cv::contourArea(border) / static_cast<double>(small.total());
      if (area < smallest_area || area > largest_area) continue;
      if (seed) {
        const Eigen::Vector2d s = (seed->array() + 0.5) * scale - 0.5;
        const cv::Point2f place(static_cast<float>(s.x()), static_cast<float>(s.y()));
        if (cv::pointPolygonTest(border, place, false) < 0) continue;
      }
      double score = border_gradient(border, gradient);
      if (previous.cols() > 0) score *= 0.2 + 0.8 * overlap(border, before);
      candidates.push_back({std::move(border), area, score});
    }
  }
  BrightRegion region;
  const auto best = std::max_element(candidates.begin(), candidates.end(),
                                     [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  if (best == candidates.end() || !(best->score > 0.0)) return region;
  region.border = ((to_matrix(best->border).array() + 0.5) / scale - 0.5).matrix();
  region.has_rival =
      std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) { return is_rival(other, *best); });
  return region;
}

}  // namespace tissue_stiffness
