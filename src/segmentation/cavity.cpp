#include "segmentation/cavity.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "segmentation/outline.hpp"

namespace tissue_stiffness {
namespace {

constexpr int working_width = 320;          // [pixel] speckle leaves no more detail for the path
constexpr double spacing = 2.5;             // [pixel] between contour points
constexpr double band = 0.15;               // of the radius: largest motion between frames
constexpr double smallest_score = 0.25;     // mean contrast of a path that is a cavity's
constexpr double lost_score = 0.15;         // below it the previous outline's surroundings hold no cavity any more
constexpr double smallest_fraction = 0.25;  // of the outline that must be wall

double mean_radius(const Eigen::Matrix2Xd& points) {
  return std::sqrt(std::abs(signed_area(points)) / M_PI);
}

/// The first pass is free and finds centre and size. The next ones follow the shape found so far, which need not be round.
WallPath trace_from(const cv::Mat& small, Pool pool) {
  WallPath path = trace_wall(small, pool, Eigen::Matrix2Xd(2, 0), 0.0);
  for (const double reach : {0.5, 0.4, 0.3}) {
    pool.centre = centroid(path.points);
    pool.radius = mean_radius(path.points);
    path = trace_wall(small, pool, path.points, reach);
  }
  return path;
}

}  // namespace

Segmentation CavitySegmenter::segment(const cv::Mat& image, double stamp) {
  const cv::Mat grey = to_grey(image);
  if (std::min(grey.cols, grey.rows) < smallest_image) return {{}, "the image is smaller than 32 x 32 pixels"};
  const double scale = std::min(1.0, static_cast<double>(working_width) / grey.cols);
  cv::Mat small;
  cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  cv::GaussianBlur(small, small, {}, 1.5);
  const auto to_small = [&](const Eigen::Matrix2Xd& p) -> Eigen::Matrix2Xd { return (p.array() + 0.5) * scale - 0.5; };

  WallPath path;
  if (previous_.cols() > 0) {
    const Eigen::Matrix2Xd before = to_small(previous_);
    path = trace_wall(small, {centroid(before), mean_radius(before), 0.0}, before, band);
  }
  if (path.score < (previous_.cols() > 0 ? lost_score : smallest_score)) {
    Pool pool = find_pool(small);
    if (seed_) pool.centre = to_small(*seed_);
    if (seed_) pool.radius = 0.1 * small.rows;
    if (pool.radius < 3.0) return {{}, "no dark pool inside a bright wall"};
    const WallPath fresh = trace_from(small, pool);
    if (fresh.score > path.score) path = fresh;
  }
  if (path.score < lost_score || (previous_.cols() == 0 && path.score < smallest_score))
    return {{}, "no dark pool inside a bright wall"};

  Eigen::Matrix2Xd outline = (path.points.array() + 0.5) / scale - 0.5;
  outline = resample(smooth_keeping_bends(resample(outline, spacing), 2.0), spacing);
  const double radius = mean_radius(outline);
  const WallEdges edges = wall_edges(grey, outline, outward_normals(outline, 4.0), radius);
  const double found =
      static_cast<double>(edges.sigma.array().isFinite().count()) / static_cast<double>(edges.sigma.size());
  if (found < smallest_fraction) return {{}, "too little of the wall around the pool is bright"};
  previous_ = outline;
  outline += outward_normals(outline, 4.0) * edges.offsets.asDiagonal();
  return {{stamp, image.cols, image.rows, true, outline, outward_normals(outline, 3.0), edges.sigma}, ""};
}

}  // namespace tissue_stiffness
