#pragma once

#include <optional>
#include <vector>

#include "segmentation/body_contrast.hpp"
#include "segmentation/edge_fit.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Finds the outline of a body against a textured background that is darker, brighter or of another colour (BodyContrast).
///
/// 1. Region: it is the connected region above some threshold with the largest mean gradient along its border. It is an
///    extremal region; Matas et al. 2002 keep the most stable one, and here it is the sharpest one. The gradient is
///    weighted by the region's overlap with the previous frame's. An image with another region of about this sharpness and
///    size is refused, unless a seed or the previous frame chooses.
/// 2. Outline: it is the path along the sharpest falls from inside to outside in a band around that border (dynamic
///    programming). The band is wide outwards, because shading may hide part of the body from any threshold.
/// 3. Edge: it is a blurred step that is fitted to the profile along each normal (StepEdge). The blur is the best one for
///    the whole frame.
///
/// The sigma of a point is the noise of the profiles over the root of the edge's information, and at least the scatter
/// between neighbours. The term blur^2/2 |curvature|, by which blur rounds corners, is added in quadrature. The sigma is
/// infinite where no step was found, where the step disagrees with its neighbours, and at the image's border. An outline
/// is refused when less than half of it is an edge, or when most of what it encloses has another colour than the body.
class SilhouetteSegmenter : public Segmenter {
 public:
  explicit SilhouetteSegmenter(const SegmentationSettings& settings);
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override { previous_.resize(2, 0); }

 private:
  std::optional<Eigen::Vector2d> seed_;
  BodyContrast contrast_;
  std::vector<StepEdge> edges_;  ///< one for each blur that is tried
  Eigen::Matrix2Xd previous_;    ///< last outline found [pixel]
};

struct BrightRegion {
  Eigen::Matrix2Xd border;  ///< [pixel]; no points: nothing was found
  bool has_rival = false;   ///< another region is about as sharp and as large
};

/// Returns the most sharply bounded bright region, all of which is above `least`. `previous`: last outline, may be empty.
BrightRegion sharpest_region(const cv::Mat& grey, const std::optional<Eigen::Vector2d>& seed,
                             const Eigen::Matrix2Xd& previous, double least);

/// Returns the outline along the sharpest falls, with points `spacing` [pixel] apart. The search starts from the border of
/// the region above, from the ellipse of its moments (because shading may hide part of the body from any threshold), and
/// from the previous outline. The sharpest result is returned.
Eigen::Matrix2Xd find_outline(const cv::Mat& grey, const Eigen::Matrix2Xd& region, const Eigen::Matrix2Xd& previous,
                              double spacing);

}  // namespace tissue_stiffness
