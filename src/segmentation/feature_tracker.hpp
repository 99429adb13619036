#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/feature_tracks.hpp"

namespace tissue_stiffness {

/// Result for one image: tracks, or the reason why there are none (`tracks` is then empty).
struct TrackedFeatures {
  FeatureTracks tracks;
  std::string reason;
  bool found() const { return !tracks.empty(); }
};

/// Follows features through a sequence of images. The first image in which there are enough is the reference. Each feature
/// is compared with the reference itself and not with the image before, so that errors do not add up.
class FeatureTracker {
 public:
  virtual ~FeatureTracker() = default;
  /// `image`: CV_8UC1 or CV_8UC3 (BGR). Throws InputError for another type, an empty image, one whose size is not that of
  /// the reference, or a region of interest outside it.
  virtual TrackedFeatures track(const cv::Mat& image, double stamp) = 0;
  /// Forgets the reference.
  virtual void reset() = 0;
};

std::unique_ptr<FeatureTracker> make_feature_tracker(const FeatureSettings& settings);

/// One column of FeatureTracks.
struct TrackedFeature {
  int id;
  cv::Point2f pixel, reference;
  double sigma, window;
};
FeatureTracks empty_tracks(const cv::Mat& image, double stamp);
void add_feature(const TrackedFeature& feature, FeatureTracks& tracks);

}  // namespace tissue_stiffness
