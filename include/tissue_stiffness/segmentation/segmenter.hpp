#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

/// Result for one image: a contour, or the reason why there is none (`contour` is then empty).
struct Segmentation {
  Contour contour;
  std::string reason;
  bool found() const { return !contour.empty(); }
};

/// Finds the outline of the tissue in a sequence of 8-bit images. It keeps what it learnt from earlier frames, so that
/// neighbouring frames agree. A frame in which nothing is found does not change this memory.
class Segmenter {
 public:
  virtual ~Segmenter() = default;
  /// `image`: CV_8UC1 or CV_8UC3 (BGR). Throws InputError for another type or an empty image, but never because of the
  /// image's content.
  virtual Segmentation segment(const cv::Mat& image, double stamp) = 0;
  /// Forgets all earlier frames.
  virtual void reset() = 0;
};

std::unique_ptr<Segmenter> make_segmenter(const SegmentationSettings& settings);

}  // namespace tissue_stiffness
