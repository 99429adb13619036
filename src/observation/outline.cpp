#include "observation/outline.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kAgree = 0.3;  // smallest cosine between the normals of measurement and model

Eigen::Vector2d outward(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& inside) {
  Eigen::Vector2d n(to.y() - from.y(), from.x() - to.x());
  if (n.dot(inside - from) > 0.0) n = -n;
  const double length = n.norm();
  return length > 0.0 ? Eigen::Vector2d(n / length) : Eigen::Vector2d(0.0, 0.0);
}

}  // namespace

std::vector<SurfaceEdge> surface_edges(const SurfaceTriangles& triangles) {
  std::map<std::pair<int, int>, std::size_t> known;
  std::vector<SurfaceEdge> edges;
  for (Eigen::Index t = 0; t < triangles.nodes.cols(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int a = triangles.nodes(i, t), b = triangles.nodes((i + 1) % 3, t), c = triangles.nodes((i + 2) % 3, t);
      const auto twin = known.find({b, a});
      if (twin == known.end()) {
        known[{a, b}] = edges.size();
        edges.push_back({a, b, t, -1, c, -1});
      } else {
        edges[twin->second].right = t;
        edges[twin->second].right_opposite = c;
      }
    }
  }
  return edges;
}

std::vector<OutlineSegment> silhouette(const SurfaceTriangles& triangles, const std::vector<SurfaceEdge>& edges,
                                       const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const Camera& camera) {
  const Eigen::Index count = triangles.nodes.cols();
  const Eigen::Vector3d eye = camera.model_from_sensor.translation();
  std::vector<char> faces(static_cast<std::size_t>(count));
  for (Eigen::Index t = 0; t < count; ++t) {
    const Eigen::Vector3d a = positions.col(triangles.nodes(0, t)), b = positions.col(triangles.nodes(1, t)),
                          c = positions.col(triangles.nodes(2, t));
    faces[static_cast<std::size_t>(t)] = (b - a).cross(c - a).dot(eye - a) > 0.0;
  }
  std::vector<OutlineSegment> outline;
  for (const SurfaceEdge& edge : edges) {
    const bool left = faces[static_cast<std::size_t>(edge.left)] != 0;
    const bool right = edge.right >= 0 && faces[static_cast<std::size_t>(edge.right)] != 0;
    if (left == right) continue;
    const int opposite = left ? edge.left_opposite : edge.right_opposite;
    const Eigen::Vector3d middle = 0.5 * (positions.col(edge.from) + positions.col(edge.to));
    const double depth = (camera.model_from_sensor.inverse() * middle).z();
    const Eigen::Vector2d from = camera.project(positions.col(edge.from)), to = camera.project(positions.col(edge.to));
    outline.push_back({from,
                       to,
                       {edge.from, edge.from, 0.0},
                       {edge.to, edge.to, 0.0},
                       outward(from, to, camera.project(positions.col(opposite))),
                       depth / camera.fx});
  }
  return outline;
}

std::vector<OutlineSegment> section_by_plane(const SurfaceTriangles& triangles,
                                             const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const Camera& camera,
                                             bool cavity) {
  const Eigen::Isometry3d to_sensor = camera.model_from_sensor.inverse();
  std::vector<OutlineSegment> outline;
  for (Eigen::Index t = 0; t < triangles.nodes.cols(); ++t) {
    Eigen::Matrix3d x;
    for (int i = 0; i < 3; ++i) x.col(i) = to_sensor * positions.col(triangles.nodes(i, t));
    if (x.row(2).minCoeff() > 0.0 || x.row(2).maxCoeff() <= 0.0) continue;
    std::array<Eigen::Vector3d, 2> places;
    std::array<OutlineEnd, 2> ends{};
    std::size_t found = 0;
    for (int i = 0; i < 3 && found < 2; ++i) {
      const Eigen::Vector3d a = x.col(i), b = x.col((i + 1) % 3);
      if ((a.z() > 0.0) == (b.z() > 0.0)) continue;
      const double share = a.z() / (a.z() - b.z());
      places[found] = a + share * (b - a);
      ends[found++] = {triangles.nodes(i, t), triangles.nodes((i + 1) % 3, t), share};
    }
    Eigen::Vector2d normal = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).head<2>();
    const double length = normal.norm();
    if (found < 2 || !(length > 0.0)) continue;
    normal *= (cavity ? -1.0 : 1.0) / length;
    const auto pixel = [&camera](const Eigen::Vector3d& p) {
      return Eigen::Vector2d(camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy);
    };
    outline.push_back({pixel(places[0]), pixel(places[1]), ends[0], ends[1], normal, 1.0 / camera.fx});
  }
  return outline;
}

namespace {

// `across`: what moves the pixel along the depth, over what moves the depth.
Eigen::Matrix<double, 2, 3> pixel_tangent_across(const Eigen::Vector3d& across, double depth, const Camera& camera) {
  const Eigen::Matrix3d turn = camera.model_from_sensor.inverse().linear();
  const Eigen::Matrix<double, 2, 3> flat = turn.topRows<2>() - across.head<2>() / across.z() * turn.row(2);
  return Eigen::Vector2d(camera.fx, camera.fy).asDiagonal() * flat / depth;
}

}  // namespace

Eigen::Matrix<double, 2, 3> pixel_tangent(const Eigen::Vector3d& point, const Camera& camera) {
  const Eigen::Vector3d across = camera.model_from_sensor.inverse() * point;
  return pixel_tangent_across(across, across.z(), camera);
}

Eigen::Matrix<double, 2, 3> pixel_tangent(const OutlineEnd& end, const Eigen::Ref<const Eigen::Matrix3Xd>& positions,
                                          const Camera& camera) {
  if (camera.projection == Camera::Projection::pinhole) return pixel_tangent(positions.col(end.node), camera);
  const Eigen::Vector3d along_edge = positions.col(end.other) - positions.col(end.node);
  return pixel_tangent_across(camera.model_from_sensor.inverse().linear() * along_edge, 1.0, camera);
}

double distance_along_normal(const std::vector<OutlineSegment>& outline, const Eigen::Vector2d& point,
                             const Eigen::Vector2d& normal, double reach, std::size_t& segment) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const OutlineSegment& s = outline[i];
    if (s.normal.dot(normal) < kAgree) continue;
    // point + d normal = from + r (to - from)
    const Eigen::Vector2d edge = s.to - s.from, offset = s.from - point;
    const double cross = normal.x() * edge.y() - normal.y() * edge.x();
    if (std::abs(cross) < 1e-12) continue;
    const double r = (normal.y() * offset.x() - normal.x() * offset.y()) / cross;
    if (r < 0.0 || r > 1.0) continue;
    const double d = (offset.x() * edge.y() - offset.y() * edge.x()) / cross;
    if (std::abs(d) > reach || std::abs(d) >= std::abs(best)) continue;  // false while best is NaN
    best = d;
    segment = i;
  }
  return best;
}

}  // namespace tissue_stiffness
