#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/camera.hpp"

namespace tissue_stiffness {

/// Returns the direction of a pixel of the undistorted image in the sensor's frame, with depth 1. In a slice it is the
/// place of the pixel [m], with depth 0.
inline Eigen::Vector3d sensor_ray(const Camera& camera, const Eigen::Vector2d& pixel) {
  const double depth = camera.projection == Camera::Projection::slice ? 0.0 : 1.0;
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, depth};
}

/// Returns the place of a pixel in the model frame, at a depth [m] before a pinhole. A slice has no depth.
inline Eigen::Vector3d place_of(const Camera& camera, const Eigen::Vector2d& pixel, double depth) {
  const double scale = camera.projection == Camera::Projection::slice ? 1.0 : depth;
  return camera.model_from_sensor * Eigen::Vector3d(scale * sensor_ray(camera, pixel));
}

/// Returns the depth of a point of the model frame before the sensor [m].
inline double depth_of(const Camera& camera, const Eigen::Vector3d& point) {
  return (camera.model_from_sensor.inverse() * point).z();
}

}  // namespace tissue_stiffness
