#pragma once

#include <optional>

#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Inner edge of the bright wall around a dark pool in B-mode ultrasound.
///
/// 1. Centre: `seed`, or the place whose rays meet the clearest walls (find_pool).
/// 2. Path: in polar coordinates the closed path of largest ratio of averages, wall over pool (trace_wall). The averages
///    outside the path reach over more than a valve leaflet's thickness. From the second frame on the path stays in a band
///    around the previous one; within it the previous frame has no weight, so the outline does not lag.
/// 3. Edge: along each normal where mean echo power is half way between pool and wall (wall_edges).
///
/// sigma joins the scatter between neighbours and the doubt about the half-power point. It is infinite where no thick wall
/// lies outside: at the open base, across a valve, in drop-outs. Errors of neighbours are correlated over about a speckle's
/// width and, for the common shift to half power, over a twentieth of the outline: sigma is the marginal one.
class CavitySegmenter : public Segmenter {
 public:
  explicit CavitySegmenter(const SegmentationSettings& settings) : seed_(settings.seed), previous_(2, 0) {}
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override { previous_.resize(2, 0); }

 private:
  std::optional<Eigen::Vector2d> seed_;
  Eigen::Matrix2Xd previous_;  ///< last outline found [pixel]
};

/// A dark place with bright surroundings, in pixels of the image searched.
struct Pool {
  Eigen::Vector2d centre;
  double radius = 0.0;  ///< root mean square distance to the wall
  double score = 0.0;   ///< mean contrast of the wall along rays, 0 ... 1
};

/// The pool with the clearest wall all around. `grey`: smoothed, CV_32FC1.
Pool find_pool(const cv::Mat& grey);

struct WallPath {
  Eigen::Matrix2Xd points;  ///< closed, one a ray [pixel]
  double score = 0.0;       ///< mean of (wall - pool) / (brightest wall on the ray) along it, 0 ... 1
};

/// Closed path around `pool.centre` of largest contrast. `near_path`: empty, or an earlier outline that it must stay near,
/// within `reach` of the pool's radius; bends are then resisted relative to that outline.
WallPath trace_wall(const cv::Mat& grey, const Pool& pool, const Eigen::Matrix2Xd& near_path, double reach);

struct WallEdges {
  Eigen::VectorXd offsets;  ///< along the normals [pixel]
  Eigen::VectorXd sigma;    ///< [pixel], infinity where there is no wall
};

/// Half-power point of the wall's inner edge along each normal.
///
/// Blur by the point-spread function mixes mean echo power, so that the edge lies where power is half way, whatever the
/// pulse; half way in the displayed, log-compressed grey it is not (it lies in the pool). The grey levels a decibel come
/// from the image: log-compressed fully developed speckle has a standard deviation of 5.57 dB (Dutt & Greenleaf 1996). The
/// steep crossing half way in grey locates each point; its distance to the half-power crossing is read off profiles
/// averaged over a stretch of the outline, where speckle averages out.
WallEdges wall_edges(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, const Eigen::Matrix2Xd& normals, double radius);

}  // namespace tissue_stiffness
