#include "tissue_stiffness/segmentation/segmenter.hpp"

#include "segmentation/area_watch.hpp"
#include "segmentation/cavity.hpp"
#include "segmentation/mask.hpp"
#include "segmentation/region_of_interest.hpp"
#include "segmentation/silhouette.hpp"

namespace tissue_stiffness {

std::unique_ptr<Segmenter> make_segmenter(const SegmentationSettings& settings) {
  using Kind = SegmentationSettings::Kind;
  if (settings.kind == Kind::mask) return std::make_unique<AreaWatch>(std::make_unique<MaskSegmenter>(settings));
  SegmentationSettings inner = settings;
  if (settings.roi && settings.seed) *inner.seed -= Eigen::Vector2d(settings.roi->u, settings.roi->v);
  std::unique_ptr<Segmenter> segmenter;
  if (settings.kind == Kind::cavity) {
    segmenter = std::make_unique<CavitySegmenter>(inner);
  } else {
    segmenter = std::make_unique<SilhouetteSegmenter>(inner);
  }
  if (settings.roi) segmenter = std::make_unique<RegionOfInterest>(*settings.roi, std::move(segmenter));
  if (settings.kind == Kind::cavity) return segmenter;  // whose search follows the outline before
  return std::make_unique<AreaWatch>(std::move(segmenter));
}

}  // namespace tissue_stiffness
