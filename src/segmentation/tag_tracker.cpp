#include "segmentation/tag_tracker.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "segmentation/outline.hpp"
#include "segmentation/region_of_interest.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSigma = 0.1;  // [pixel] of a refined corner
static_assert(cv::aruco::DICT_4X4_50 == 0 && cv::aruco::DICT_APRILTAG_36h11 == 20, "the numbers that settings read");

}  // namespace

TagTracker::TagTracker(const FeatureSettings& settings)
    : settings_(settings), dictionary_(cv::aruco::getPredefinedDictionary(settings.dictionary)) {}

TrackedFeatures TagTracker::track(const cv::Mat& image, double stamp) {
  const cv::Mat grey = grey_bytes(image);
  const std::map<int, cv::Point2f> corners = detect(grey);
  if (reference_.empty()) {
    for (const auto& [id, corner] : corners) {
      if (!settings_.roi || rectangle_in(grey, *settings_.roi).contains(corner)) reference_[id] = corner;
    }
  }
  FeatureTracks out = empty_tracks(grey, stamp);
  for (const auto& [id, corner] : corners) {
    const auto known = reference_.find(id);
    if (known == reference_.end()) continue;
    add_feature({id, corner, known->second, std::sqrt(2.0) * kSigma, 0.0}, out);  // the reference has the same error
  }
  if (!out.empty()) return {std::move(out), ""};
  return {{}, corners.empty() ? "no tag of the dictionary" : "no tag that the first image with tags shows, too"};
}

std::map<int, cv::Point2f> TagTracker::detect(const cv::Mat& grey) const {
  const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  std::vector<std::vector<cv::Point2f>> quadrangles;
  std::vector<int> tags;
  cv::aruco::detectMarkers(grey, dictionary_, quadrangles, tags, parameters);
  std::map<int, cv::Point2f> out;
  for (std::size_t k = 0; k < tags.size(); ++k) {
    for (int c = 0; c < 4; ++c) out[4 * tags[k] + c] = quadrangles[k][static_cast<std::size_t>(c)];
  }
  return out;
}

}  // namespace tissue_stiffness
