#pragma once

#include <Eigen/Geometry>

namespace tissue_stiffness {

/// The sensor that recorded a contour. A pinhole camera has u = fx x/z + cx, v = fy y/z + cy with x, y, z in the optical
/// frame (z forward, REP-103), and a lens that moves each pixel of this image. An ultrasound slice has u = fx x + cx, v =
/// fy y + cy with fx, fy in pixel/m, and its image lies in the plane z = 0.
struct Camera {
  enum class Projection { pinhole, slice };
  enum class Lens { none, plumb_bob, rational_polynomial, equidistant };

  Projection projection = Projection::pinhole;
  int width = 0, height = 0;              ///< [pixel]
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [pixel], or [pixel/m] for a slice
  Lens lens = Lens::none;
  Eigen::VectorXd distortion;  ///< coefficients of the lens, in the order of CameraInfo's D
  Eigen::Isometry3d model_from_sensor = Eigen::Isometry3d::Identity();  ///< the sensor's pose in `model`, from tf2

  /// Projects a point of the model frame [m] to the undistorted image [pixel], as a pinhole or a slice. Returns NaN for a
  /// point at or behind the pinhole.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;
};

}  // namespace tissue_stiffness
