#include "segmentation/feature_tracker.hpp"

#include "segmentation/tag_tracker.hpp"
#include "segmentation/texture_tracker.hpp"

namespace tissue_stiffness {

std::unique_ptr<FeatureTracker> make_feature_tracker(const FeatureSettings& settings) {
  if (settings.kind == FeatureSettings::Kind::tags) return std::make_unique<TagTracker>(settings);
  return std::make_unique<TextureTracker>(settings);
}

FeatureTracks empty_tracks(const cv::Mat& image, double stamp) {
  FeatureTracks out;
  out.stamp = stamp;
  out.width = image.cols;
  out.height = image.rows;
  return out;
}

void add_feature(const TrackedFeature& feature, FeatureTracks& tracks) {
  const Eigen::Index n = tracks.size() + 1;
  tracks.ids.conservativeResize(n);
  tracks.pixels.conservativeResize(Eigen::NoChange, n);
  tracks.reference.conservativeResize(Eigen::NoChange, n);
  tracks.sigma.conservativeResize(n);
  tracks.windows.conservativeResize(n);
  tracks.ids[n - 1] = feature.id;
  tracks.pixels.col(n - 1) << feature.pixel.x, feature.pixel.y;
  tracks.reference.col(n - 1) << feature.reference.x, feature.reference.y;
  tracks.sigma[n - 1] = feature.sigma;
  tracks.windows[n - 1] = feature.window;
}

}  // namespace tissue_stiffness
