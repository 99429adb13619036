#pragma once

#include <map>
#include <opencv2/aruco.hpp>

#include "segmentation/feature_tracker.hpp"

namespace tissue_stiffness {

/// Follows the corners of ArUco or AprilTag markers. The corner c (0 to 3, clockwise from the tag's own upper left) of tag
/// k is feature 4 k + c. Tags that the reference does not show are left out.
class TagTracker : public FeatureTracker {
 public:
  explicit TagTracker(const FeatureSettings& settings);
  TrackedFeatures track(const cv::Mat& image, double stamp) override;
  void reset() override { reference_.clear(); }

 private:
  std::map<int, cv::Point2f> detect(const cv::Mat& grey) const;

  FeatureSettings settings_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  std::map<int, cv::Point2f> reference_;  ///< [pixel] by number
};

}  // namespace tissue_stiffness
