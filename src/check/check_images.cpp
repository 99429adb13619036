#include "check/check_images.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

#include "segmentation/brightness.hpp"
#include "segmentation/region_of_interest.hpp"

namespace tissue_stiffness {

SetupFindings check_images(const ObservationSettings& observation, const std::vector<cv::Mat>& images) {
  const SegmentationSettings& segmentation = observation.segmentation;
  const bool silhouette = segmentation.kind == SegmentationSettings::Kind::silhouette;
  const bool by_colour = segmentation.body == SegmentationSettings::Body::colour;
  if (observation.kind != ObservationKind::contour || !silhouette || by_colour) return {};
  const bool bright = segmentation.body == SegmentationSettings::Body::bright;
  const auto is_wrong = [&](const cv::Mat& image) {
    const cv::Mat part = segmentation.roi ? image(rectangle_in(image, *segmentation.roi)) : image;
    if (bright) return shows_dark_body(part);
    cv::Mat inverted;
    cv::bitwise_not(part, inverted);
    return shows_dark_body(inverted);
  };
  const auto wrong = std::count_if(images.begin(), images.end(), is_wrong);
  if (2 * wrong <= static_cast<std::ptrdiff_t>(images.size())) return {};
  return {{observation.topic, observation.topic + ": the body is " + (bright ? "darker" : "brighter") +
                                  " than its background in " + std::to_string(wrong) + " of " +
                                  std::to_string(images.size()) + " images, and `segmentation: {body: " +
                                  (bright ? "bright" : "dark") + "}` needs it " + (bright ? "brighter" : "darker") +
                                  "; write `body: " + (bright ? "dark" : "bright") + "`, or name its colour."}};
}

}  // namespace tissue_stiffness
