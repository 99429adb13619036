#include "segmentation/texture_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <string>

#include "segmentation/outline.hpp"
#include "segmentation/region_of_interest.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kLevels = 3;              // of the pyramid, besides the image
constexpr int kIterations = 40;         // of each search
constexpr double kCloseEnough = 0.005;  // [pixel] at which a search ends
constexpr double kQuality = 0.002;      // of the best corner: the worst that is considered
constexpr double kSpread = 0.6;         // of the distance that features would have if they filled the image
constexpr double kWorst = 0.25;         // [pixel] to which a feature's place has to be known in the reference
constexpr double kReturns = 1.0;        // [pixel] by which the way back may miss
constexpr std::size_t kFewest = 8;      // features

const cv::Size kWindow(21, 21);  // [pixel] of the search

void search(const std::vector<cv::Mat>& first, const std::vector<cv::Mat>& second, const std::vector<cv::Point2f>& from,
            std::vector<cv::Point2f>& to, std::vector<unsigned char>& found) {
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, kCloseEnough);
  cv::calcOpticalFlowPyrLK(first, second, from, to, found, cv::noArray(), kWindow, kLevels, until,
                           cv::OPTFLOW_USE_INITIAL_FLOW);
}

}  // namespace

void TextureTracker::reset() {
  pyramid_.clear();
  features_.clear();
}

TrackedFeatures TextureTracker::track(const cv::Mat& image, double stamp) {
  const cv::Mat grey = grey_bytes(image);
  const std::string allowed = "; allowed: " + std::to_string(kFewest) + " or more";
  if (features_.empty() && !choose(grey)) {
    const std::string few = std::to_string(features_.size()) + " corners of a texture";
    reset();
    return {{}, few + allowed};
  }
  follow(grey);
  FeatureTracks out = empty_tracks(grey, stamp);
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const Feature& feature = features_[i];
    if (feature.sigma < 0.0) continue;
    add_feature({static_cast<int>(i), feature.last, feature.reference, feature.sigma, TextureWindow::half}, out);
  }
  if (out.size() >= static_cast<Eigen::Index>(kFewest)) return {std::move(out), ""};
  return {{}, std::to_string(out.size()) + " of " + std::to_string(features_.size()) + " features" + allowed};
}

void TextureTracker::follow(const cv::Mat& grey) {
  if (grey.size() != pyramid_.front().size()) {
    throw InputError("image", std::to_string(grey.cols) + " x " + std::to_string(grey.rows) + " pixels",
                     "the size of the first image");
  }
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(grey, pyramid, kWindow, kLevels, false);
  std::vector<cv::Point2f> from, to;
  for (const Feature& feature : features_) from.push_back(feature.reference), to.push_back(feature.last);
  std::vector<cv::Point2f> back = from;
  std::vector<unsigned char> there, returned;
  search(pyramid_, pyramid, from, to, there);
  search(pyramid, pyramid_, to, back, returned);
  const cv::Mat smooth = smooth_image(grey);
  cv::parallel_for_(cv::Range(0, static_cast<int>(features_.size())), [&](const cv::Range& range) {
    for (int k = range.start; k < range.end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      Feature& feature = features_[i];
      feature.sigma = -1.0;
      if (there[i] == 0 || returned[i] == 0 || !(cv::norm(back[i] - from[i]) < kReturns)) continue;
      const std::optional<TextureWindow::Place> place = feature.window.find(smooth, to[i]);
      if (!place) continue;
      feature.last = place->centre;
      feature.sigma = place->sigma;
    }
  });
}

// Makes this image the reference if it has enough corners. They are spread, so that they tell the whole motion.
bool TextureTracker::choose(const cv::Mat& grey) {
  const cv::Rect all(0, 0, grey.cols, grey.rows), part = settings_.roi ? rectangle_in(grey, *settings_.roi) : all;
  cv::Mat mask = cv::Mat::zeros(grey.size(), CV_8UC1);
  mask(part).setTo(255);
  const double apart = kSpread * std::sqrt(part.area() / static_cast<double>(settings_.most));
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(grey, corners, settings_.most, kQuality, std::max(3.0, apart), mask);
  const cv::Mat smooth = smooth_image(grey);
  const double noise = image_noise(grey);
  constexpr int half = TextureWindow::half;
  const cv::Rect inside(half, half, grey.cols - 2 * half, grey.rows - 2 * half);
  for (const cv::Point2f& corner : corners) {
    const cv::Point pixel(cvRound(corner.x), cvRound(corner.y));
    if (!inside.contains(pixel)) continue;
    TextureWindow window(smooth, pixel);
    const double sigma = window.sigma(noise);
    if (sigma < kWorst) features_.push_back({corner, corner, std::move(window), sigma});
  }
  if (features_.size() < kFewest) return false;
  cv::buildOpticalFlowPyramid(grey.clone(), pyramid_, kWindow, kLevels, false);
  return true;
}

}  // namespace tissue_stiffness
