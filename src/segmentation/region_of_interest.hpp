#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Returns the region of interest as OpenCV's rectangle. Throws InputError for one that is not wholly inside the image.
cv::Rect rectangle_in(const cv::Mat& image, const PixelBox& roi);

/// Shows another segmenter only the part of each image that the body lies in. An outline that comes near the border of this
/// part is refused, because the body may go on beyond it. The next image is then searched without a memory of this one.
class RegionOfInterest : public Segmenter {
 public:
  /// `inner` sees the part `roi` alone, and counts its pixels from there.
  RegionOfInterest(const PixelBox& roi, std::unique_ptr<Segmenter> inner) : roi_(roi), inner_(std::move(inner)) {}
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override { inner_->reset(); }

 private:
  PixelBox roi_;
  std::unique_ptr<Segmenter> inner_;
};

}  // namespace tissue_stiffness
