#include "meshing/revolution_profile.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace tissue_stiffness {

double RevolutionProfile::radius(double angle) const {
  double sum = 0.0;
  for (Eigen::Index n = 0; n < coefficients_.size(); ++n)
    sum += coefficients_[n] * std::cos(static_cast<double>(n) * angle);
  return sum;
}

double RevolutionProfile::radius_slope(double angle) const {
  double sum = 0.0;
  for (Eigen::Index n = 1; n < coefficients_.size(); ++n) {
    sum -= static_cast<double>(n) * coefficients_[n] * std::sin(static_cast<double>(n) * angle);
  }
  return sum;
}

Eigen::Vector2d RevolutionProfile::meridian(double angle) const {
  return radius(angle) * Eigen::Vector2d(std::sin(angle), std::cos(angle));
}

double RevolutionProfile::angle(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d x = point - centre_;
  return std::atan2(x.cross(axis_).norm(), x.dot(axis_));
}

// The gradients are grad |x| = x/|x| and grad t = -(a - cos t x/|x|) / (|x| sin t).
Eigen::Vector3d RevolutionProfile::gradient(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d x = point - centre_;
  const double length = x.norm();
  if (length == 0.0) return axis_;
  const Eigen::Vector3d outward = x / length;
  const Eigen::Vector3d along = outward.dot(axis_) * outward - axis_;  // length sin t, towards larger t
  const double sine = along.norm();
  if (sine < 1e-12) return outward;
  return outward - radius_slope(angle(point)) / (length * sine) * along;
}

double RevolutionProfile::distance(const Eigen::Vector3d& point) const {
  return ((point - centre_).norm() - radius(angle(point))) / gradient(point).norm();
}

Eigen::Vector3d RevolutionProfile::normal(const Eigen::Vector3d& point) const {
  return gradient(point).normalized();
}

Eigen::Vector3d RevolutionProfile::project(const Eigen::Vector3d& point) const {
  Eigen::Vector3d x = point;
  for (int i = 0; i < 8; ++i) x -= distance(x) * normal(x);
  return x;
}

}  // namespace tissue_stiffness
