#include "tissue_stiffness/types/camera.hpp"

#include <limits>

namespace tissue_stiffness {

Eigen::Vector2d Camera::project(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = model_from_sensor.inverse() * point;
  if (projection == Projection::slice) return {fx * p.x() + cx, fy * p.y() + cy};
  if (p.z() <= 0.0) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
}

}  // namespace tissue_stiffness
