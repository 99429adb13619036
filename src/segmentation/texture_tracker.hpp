#pragma once

#include <vector>

#include "segmentation/feature_tracker.hpp"
#include "segmentation/texture_window.hpp"

namespace tissue_stiffness {

/// Follows corners of the image (Shi & Tomasi 1994) whose place the texture around them tells to a quarter of a pixel.
///
/// 1. Search: the iterative method of Lucas & Kanade (1981) in a pyramid of images (Bouguet 2001), from where each was seen
///    last. A feature is lost in an image if following it back does not lead to where it came from.
/// 2. Place: the window around it is fitted to the image with a shift, a linear deformation, a brightness and a contrast
///    (TextureWindow). What is left tells the standard deviation of its place.
class TextureTracker : public FeatureTracker {
 public:
  explicit TextureTracker(const FeatureSettings& settings) : settings_(settings) {}
  TrackedFeatures track(const cv::Mat& image, double stamp) override;
  void reset() override;

 private:
  struct Feature {
    cv::Point2f reference, last;  ///< [pixel] in the reference, and where it was seen last
    TextureWindow window;
    double sigma;  ///< [pixel] in the image under way; negative: not found there
  };

  bool choose(const cv::Mat& grey);
  void follow(const cv::Mat& grey);

  FeatureSettings settings_;
  std::vector<cv::Mat> pyramid_;  ///< of the reference
  std::vector<Feature> features_;
};

}  // namespace tissue_stiffness
