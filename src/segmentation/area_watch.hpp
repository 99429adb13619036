#pragma once

#include <deque>
#include <memory>

#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Refuses an outline whose area jumps, because tissue does not shrink or grow by a third from one frame to the next. Such
/// an outline belongs to something else, or a part of the body is missing from it. After a refusal the next image is
/// searched without a memory. Thirty outlines in a row that agree with each other are believed again, because the first
/// ones may have been wrong. A hand that hides a part of the body for a second is not.
class AreaWatch : public Segmenter {
 public:
  explicit AreaWatch(std::unique_ptr<Segmenter> inner) : inner_(std::move(inner)) {}
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override;

 private:
  std::unique_ptr<Segmenter> inner_;
  std::deque<double> believed_;  ///< areas of the last outlines [pixel^2]
  std::deque<double> doubted_;   ///< areas of the outlines that were refused since then [pixel^2]
};

}  // namespace tissue_stiffness
