#include "tissue_stiffness/segmentation/segmenter.hpp"

#include "segmentation/cavity.hpp"
#include "segmentation/mask.hpp"
#include "segmentation/region_of_interest.hpp"
#include "segmentation/silhouette.hpp"

namespace tissue_stiffness {

std::unique_ptr<Segmenter> make_segmenter(const SegmentationSettings& settings) {
  if (settings.kind == SegmentationSettings::Kind::mask) return std::make_unique<MaskSegmenter>(settings);
  if (settings.roi) return std::make_unique<RegionOfInterest>(settings);
  if (settings.kind == SegmentationSettings::Kind::cavity) return std::make_unique<CavitySegmenter>(settings);
  return std::make_unique<SilhouetteSegmenter>(settings);
}

}  // namespace tissue_stiffness
