#pragma once

#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Takes the outline from a mask that another program has made, such as a trained network.
///
/// 1. Region: it is the largest connected part of the mask that holds the seed, or that touches the region of interest, or
///    of the whole image. Its holes are filled. Without a seed, a second part of half its size or more is a reason to
///    refuse the image.
/// 2. Edge: it is where the mask, blurred by a pixel, falls below a half along each normal of the border.
///
/// The sigma of a point is the scatter of these edges about the smoothed outline between neighbours, and at least that of
/// rounding to whole pixels. So a mask that was enlarged has the sigma of its coarse steps. An error that the mask itself
/// makes smoothly cannot be seen here; the observation's `noise` stands for it. The sigma is infinite at the image's
/// border.
class MaskSegmenter : public Segmenter {
 public:
  explicit MaskSegmenter(const SegmentationSettings& settings) : settings_(settings) {}
  /// `image`: CV_8UC1, 0 outside the body and any other value in it.
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override {}

 private:
  SegmentationSettings settings_;
};

}  // namespace tissue_stiffness
