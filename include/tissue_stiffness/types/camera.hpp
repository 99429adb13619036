#pragma once

#include <Eigen/Geometry>

namespace tissue_stiffness {

/// The sensor that recorded a contour. A pinhole camera has u = fx x/z + cx, v = fy y/z + cy with x, y, z in the optical
/// frame (z forward, REP-103) and plumb_bob distortion. An ultrasound slice has u = fx x + cx, v = fy y + cy with fx, fy in
/// pixel/m, and its image lies in the plane z = 0.
struct Camera {
  enum class Projection { pinhole, slice };

  Projection projection = Projection::pinhole;
  int width = 0, height = 0;                                                     ///< [pixel]
  double fx = 0, fy = 0, cx = 0, cy = 0;                                         ///< [pixel], or [pixel/m] for a slice
  Eigen::Matrix<double, 5, 1> distortion = Eigen::Matrix<double, 5, 1>::Zero();  ///< plumb_bob k1 k2 p1 p2 k3
  Eigen::Isometry3d model_from_sensor = Eigen::Isometry3d::Identity();           ///< the sensor's pose in `model`, from tf2

  /// Projects a point of the model frame [m] to the undistorted image [pixel], as a pinhole or a slice. Returns NaN for a
  /// point at or behind the pinhole.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;
};

}  // namespace tissue_stiffness
