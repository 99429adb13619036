#include "segmentation/region_of_interest.hpp"

#include <string>

#include "segmentation/outline.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double border = 3.0;          // [pixel] an outline this near to the region's border touches it
constexpr double unseen_border = 15.0;  // [pixel] the same without an edge: searches move an outline by up to 12 pixels

}  // namespace

cv::Rect rectangle_in(const cv::Mat& image, const PixelBox& roi) {
  const cv::Rect rectangle(roi.u, roi.v, roi.width, roi.height), whole({}, image.size());
  if ((rectangle & whole) == rectangle) return rectangle;
  throw InputError("segmentation.roi",
                   "[" + std::to_string(roi.u) + ", " + std::to_string(roi.v) + ", " + std::to_string(roi.width) + ", " +
                       std::to_string(roi.height) + "]",
                   "[u, v, width, height] inside the image of " + std::to_string(image.cols) + " x " +
                       std::to_string(image.rows) + " pixels");
}

Segmentation RegionOfInterest::segment(const cv::Mat& image, double stamp) {
  const cv::Mat part = image(rectangle_in(image, roi_));
  Segmentation found = inner_->segment(part, stamp);
  if (!found.found()) return found;
  Contour& contour = found.contour;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const double margin = std::isfinite(contour.sigma(i)) ? border : unseen_border;
    if (inside_image(contour.points.col(i), part, margin)) continue;
    inner_->reset();
    return {{}, "the outline touches the border of the region of interest"};
  }
  contour.points.colwise() += Eigen::Vector2d(roi_.u, roi_.v);
  contour.width = image.cols;
  contour.height = image.rows;
  return found;
}

}  // namespace tissue_stiffness
