#pragma once

#include <optional>

#include "tissue_stiffness/segmentation/segmenter.hpp"

namespace tissue_stiffness {

/// Finds the inner edge of the bright wall around a dark pool in B-mode ultrasound.
///
/// 1. Centre: it is `seed`, or the place whose rays meet the clearest walls (find_pool).
/// 2. Path: it is the closed path in polar coordinates with the largest contrast between wall and pool (trace_wall). The
///    averages outside the path extend over more than a valve leaflet's thickness. From the second frame on the path stays
///    in a band around the previous one. Within this band the previous frame has no weight, so the outline does not lag.
/// 3. Edge: along each normal it lies where the mean echo power is midway between pool and wall (wall_edges).
///
/// The sigma of a point combines the scatter between neighbours with the uncertainty of the half-power point. It is
/// infinite where no thick wall lies outside: at the open base, across a valve, in drop-outs. Errors of neighbours are
/// correlated over about the width of a speckle. The common shift to half power is correlated over a twentieth of the
/// outline. The sigma is the marginal standard deviation.
class CavitySegmenter : public Segmenter {
 public:
  explicit CavitySegmenter(const SegmentationSettings& settings) : seed_(settings.seed), previous_(2, 0) {}
  Segmentation segment(const cv::Mat& image, double stamp) override;
  void reset() override { previous_.resize(2, 0); }

 private:
  std::optional<Eigen::Vector2d> seed_;
  Eigen::Matrix2Xd previous_;  ///< last outline found [pixel]
};

/// A dark place with bright surroundings, in pixels of the image that was searched.
struct Pool {
  Eigen::Vector2d centre;
  double radius = 0.0;  ///< root mean square distance to the wall [pixel]
  double score = 0.0;   ///< mean contrast of the wall along the rays, 0 ... 1
};

/// Finds the pool with the clearest wall all around. `grey`: smoothed, CV_32FC1.
Pool find_pool(const cv::Mat& grey);

struct WallPath {
  Eigen::Matrix2Xd points;  ///< closed path, one point for each ray [pixel]
  double score = 0.0;       ///< mean of (wall - pool) / (brightest wall on the ray) along the path, 0 ... 1
};

/// Finds the closed path around `pool.centre` with the largest contrast. `near_path`: empty, or an earlier outline from
/// which the path may deviate by at most `reach` times the pool's radius. Bends are then resisted relative to that outline.
WallPath trace_wall(const cv::Mat& grey, const Pool& pool, const Eigen::Matrix2Xd& near_path, double reach);

struct WallEdges {
  Eigen::VectorXd offsets;  ///< shifts along the normals [pixel]
  Eigen::VectorXd sigma;    ///< [pixel], infinity where there is no wall
};

/// Finds the half-power point of the wall's inner edge along each normal.
///
/// Blur by the point-spread function mixes mean echo power. So the edge lies where the power is midway between pool and
/// wall, whatever the pulse. The midpoint in the displayed, log-compressed grey lies in the pool instead. The grey levels
/// per decibel come from the image: log-compressed fully developed speckle has a standard deviation of 5.57 dB (Dutt &
/// Greenleaf 1996). The steep crossing of the midpoint in grey locates each point. Its distance to the half-power crossing
/// is taken from profiles averaged over a stretch of the outline, where speckle averages out.
WallEdges wall_edges(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, const Eigen::Matrix2Xd& normals, double radius);

}  // namespace tissue_stiffness
