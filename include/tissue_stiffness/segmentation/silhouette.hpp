#pragma once

#include <optional>
#include <vector>

#include "tissue_stiffness/segmentation/edge_fit.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Outline of a bright body against a darker, textured background.
///
/// 1. Region: of all connected regions above some threshold, the one with the largest mean gradient along its border
///    (an extremal region; Matas et al. 2002 keep the most stable one, here the sharpest), weighted by its overlap with the
///    previous frame's.
/// 2. Outline: the path along the sharpest falls from inside to outside in a band around that border (dynamic programming).
///    The band is wide outwards, because a body's own shading may hide part of it from any threshold.
/// 3. Edge: a blurred step fitted to the profile along each normal (StepEdge); the blur is the frame's best.
///
/// sigma is the noise of the profiles over the root of the edge's information, raised to the scatter between neighbours,
/// plus blur^2/2 |curvature|, by which blur rounds corners off. It is infinite where no step was found, where the step
/// disagrees with its neighbours, and at the image's border.
class SilhouetteSegmenter : public Segmenter {
 public:
  explicit SilhouetteSegmenter(const SegmentationSettings& settings);
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override { previous_.resize(2, 0); }

 private:
  std::optional<Eigen::Vector2d> seed_;
  std::vector<StepEdge> edges_;  ///< one for each tried blur
  Eigen::Matrix2Xd previous_;    ///< last outline found [pixel]
};

/// Border [pixel] of the most sharply bounded bright region, or no points. `previous`: last outline, may be empty.
Eigen::Matrix2Xd sharpest_region(const cv::Mat& grey, const std::optional<Eigen::Vector2d>& seed,
                                 const Eigen::Matrix2Xd& previous);

/// The outline along the sharpest falls near that region, or near the ellipse of its moments (shading may hide a part of
/// the body from any threshold), or near the previous outline: whichever is sharpest. Points `spacing` apart; none without
/// a region.
Eigen::Matrix2Xd find_outline(const cv::Mat& grey, const std::optional<Eigen::Vector2d>& seed,
                              const Eigen::Matrix2Xd& previous, double spacing);

}  // namespace tissue_stiffness
