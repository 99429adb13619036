#include "nodes/force_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kLongest = 0.2;  // of the body's size
constexpr double kSlim = 0.05;    // of the longest needle: radius where a needle begins
constexpr double kFaint = 0.02;   // of the largest force: no needle

geometry_msgs::Point point(const Eigen::Vector3d& p) {
  geometry_msgs::Point out;
  out.x = p.x();
  out.y = p.y();
  out.z = p.z();
  return out;
}

// Adds a pyramid with a triangular base, whose faces are oriented outwards.
void add_needle(const Eigen::Vector3d& from, const Eigen::Vector3d& along, double radius,
                std::vector<geometry_msgs::Point>& points) {
  const Eigen::Vector3d axis = along.normalized();
  const Eigen::Vector3d side = axis.unitOrthogonal(), other = axis.cross(side);
  std::array<Eigen::Vector3d, 3> corner;
  for (std::size_t k = 0; k < corner.size(); ++k) {
    const double turn = 2.0 * M_PI * static_cast<double>(k) / 3.0;
    corner[k] = from + radius * (std::cos(turn) * side + std::sin(turn) * other);
  }
  const Eigen::Vector3d tip = from + along;
  for (std::size_t k = 0; k < corner.size(); ++k) {
    for (const Eigen::Vector3d& p : {corner[k], corner[(k + 1) % 3], tip}) points.push_back(point(p));
  }
  for (const std::size_t k : {0, 2, 1}) points.push_back(point(corner[k]));
}

}  // namespace

visualization_msgs::Marker force_marker(const MissingForce& force, const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = "missing_force";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.r = 0.45F;
  marker.color.g = 0.2F;
  marker.color.b = 0.75F;
  marker.color.a = 1.0F;
  marker.action = visualization_msgs::Marker::DELETE;
  if (force.time.empty()) return marker;
  marker.action = visualization_msgs::Marker::ADD;
  const Eigen::Matrix3Xd& largest =
      *std::max_element(force.at_nodes.begin(), force.at_nodes.end(),
                        [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  const double size = (force.places.rowwise().maxCoeff() - force.places.rowwise().minCoeff()).norm();
  const double most = largest.colwise().norm().maxCoeff(), scale = kLongest * size / most;
  for (Eigen::Index i = 0; i < largest.cols(); ++i) {
    if (largest.col(i).norm() < kFaint * most) continue;
    add_needle(force.places.col(i), scale * largest.col(i), kSlim * kLongest * size, marker.points);
  }
  return marker;
}

}  // namespace tissue_stiffness
