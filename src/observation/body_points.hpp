#pragma once

#include <Eigen/Geometry>
#include <map>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Chooses those points of a depth camera's cloud that are the body's surface.
///
/// 1. Box: points farther than `margin` from the box around the mesh at rest are left out, and so are points that are not
///    finite.
/// 2. Planes: a table, a wall or a tray is found by random sample consensus among the points outside this box, so that a
///    flat side of the body is none. Points within three standard deviations of the noise of a plane, or behind it as seen
///    from the body, are left out.
/// 3. Thinning: as many points are drawn at random as there are voxels that hold any. The means of voxels would be fewer
///    numbers with less noise. But a voxel that a surface's noise only grazes would count as much as its full neighbour,
///    and a surface near the voxels' faces would seem to lie half a standard deviation off.
/// 4. Outliers: points with too few others around them are left out.
class BodyPoints {
 public:
  /// `noise`: 1 sigma of a coordinate [m]. Throws InputError for voxels that are too many to be numbered.
  BodyPoints(const DepthCameraSettings& settings, double noise, const TetMesh& mesh);

  /// `points` [m] are in the model's frame, in any order.
  Eigen::Matrix3Xd select(const Eigen::Matrix3Xd& points) const;

 private:
  DepthCameraSettings settings_;
  double noise_ = 0.0;
  Eigen::AlignedBox3d box_, surroundings_;
  Eigen::Matrix3Xd nodes_;  ///< of the mesh at rest
};

/// Returns one for each of the model's observations that comes from a depth camera, by index in the list.
std::map<int, BodyPoints> make_body_points(const ModelSettings& settings, const TetMesh& mesh);

/// Leaves the body's points in an observation of a depth camera. Throws InputError, which names the topic, when none is.
void select_body(const std::map<int, BodyPoints>& body_points, const ModelSettings& settings, Observation* observation);

}  // namespace tissue_stiffness
