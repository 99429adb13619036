#include "check/check_images.hpp"

#include <algorithm>

#include "segmentation/brightness.hpp"

namespace tissue_stiffness {

SetupFindings check_images(const ObservationSettings& observation, const std::vector<cv::Mat>& images) {
  const bool silhouette = observation.segmentation.kind == SegmentationSettings::Kind::silhouette;
  if (!traits_of(observation.kind).image || !silhouette) return {};
  const auto dark = std::count_if(images.begin(), images.end(), shows_dark_body);
  if (2 * dark <= static_cast<std::ptrdiff_t>(images.size())) return {};
  return {{observation.topic,
           observation.topic + ": the body is darker than its background in " + std::to_string(dark) + " of " +
               std::to_string(images.size()) +
               " images, and `segmentation: {kind: silhouette}` needs it brighter; invert the images, or light the body "
               "before a dark background."}};
}

}  // namespace tissue_stiffness
