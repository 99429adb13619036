#include "rviz/body_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr double kRoom = 1.25;  // of the radius, for the motion
constexpr double kPi = 3.14159265358979323846;

}  // namespace

std::optional<BodyView> view_of_body(const Eigen::Matrix3Xd& points, double angle, double aspect) {
  if (!(angle > 0.0 && angle < kPi && aspect > 0.0 && std::isfinite(aspect))) return std::nullopt;
  const double far = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(far), high = -low;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) continue;
    low = low.cwiseMin(points.col(i));
    high = high.cwiseMax(points.col(i));
  }
  const double radius = 0.5 * (high - low).norm();
  if (!(radius > 0.0) || !low.allFinite()) return std::nullopt;
  const double tangent = std::tan(0.5 * angle) * std::min(1.0, aspect);
  return BodyView{0.5 * (low + high), kRoom * radius / std::sin(std::atan(tangent))};
}

}  // namespace tissue_stiffness
