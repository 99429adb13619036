#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/forward/closest_point.hpp"
#include "tissue_stiffness/types/camera.hpp"

namespace tissue_stiffness {

/// A piece of the model's outline in an image.
struct OutlineSegment {
  Eigen::Vector2d from, to;  ///< [pixel]
  Eigen::Vector2d normal;    ///< unit, out of the body (silhouette), out of the cavity (slice)
  int node;                  ///< a mesh node near it
  double scale;              ///< metres a pixel there
};

/// An edge of a triangulated surface with the triangles on its two sides.
struct SurfaceEdge {
  int from, to;
  Eigen::Index left, right;  ///< right is -1 on an open border
  int left_opposite, right_opposite;
};
std::vector<SurfaceEdge> surface_edges(const SurfaceTriangles& triangles);

/// Outline of the surface seen through a pinhole: edges between a triangle that faces the camera and one that does not.
std::vector<OutlineSegment> silhouette(const SurfaceTriangles& triangles, const std::vector<SurfaceEdge>& edges,
                                       const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const Camera& camera);

/// Cut of the surface with the image plane of an ultrasound slice; normals point against the surface's outward normal when
/// `cavity` is set.
std::vector<OutlineSegment> slice(const SurfaceTriangles& triangles, const Eigen::Ref<const Eigen::Matrix3Xd>& positions,
                                  const Camera& camera, bool cavity);

/// Signed distance in pixels from `point` along `normal` to the outline piece whose normal agrees and that is closest,
/// within `reach` pixels. NaN when there is none; `segment` gets its number.
double distance_along_normal(const std::vector<OutlineSegment>& outline, const Eigen::Vector2d& point,
                             const Eigen::Vector2d& normal, double reach, std::size_t& segment);

}  // namespace tissue_stiffness
