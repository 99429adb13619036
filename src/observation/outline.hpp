#pragma once

#include <Eigen/Core>
#include <vector>

#include "observation/closest_point.hpp"
#include "tissue_stiffness/types/camera.hpp"

namespace tissue_stiffness {

/// A segment ends on a mesh edge, at this share of the way from `node` to `other`.
struct OutlineEnd {
  int node, other;
  double share;
};

/// An outline segment is a straight piece of the model's outline in an image.
struct OutlineSegment {
  Eigen::Vector2d from, to;  ///< [pixel]
  OutlineEnd from_end, to_end;
  Eigen::Vector2d normal;  ///< unit vector, out of the body; out of the cavity in a slice that shows one
  double scale;            ///< metres per pixel at the segment
};

/// A surface edge knows the triangles on its two sides.
struct SurfaceEdge {
  int from, to;
  Eigen::Index left, right;  ///< right is -1 on an open border
  int left_opposite, right_opposite;
};
std::vector<SurfaceEdge> surface_edges(const SurfaceTriangles& triangles);

/// Returns the outline of the surface seen through a pinhole: the edges between a triangle that faces the camera and one
/// that does not.
std::vector<OutlineSegment> silhouette(const SurfaceTriangles& triangles, const std::vector<SurfaceEdge>& edges,
                                       const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const Camera& camera);

/// Returns the cut of the surface with the image plane of an ultrasound slice. The normals point against the surface's
/// outward normal when `cavity` is set.
std::vector<OutlineSegment> section_by_plane(const SurfaceTriangles& triangles,
                                             const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const Camera& camera,
                                             bool cavity);

/// Returns d pixel / d point of the model frame, 2 x 3 [pixel/m], of a pinhole.
Eigen::Matrix<double, 2, 3> pixel_tangent(const Eigen::Vector3d& point, const Camera& camera);

/// Returns d pixel / d position of the end's nodes, 2 x 3 [pixel/m]. That of `node` is (1 - share) times this matrix, and
/// that of `other` is `share` times it. In a slice the end slides along its mesh edge, so that it stays in the image's
/// plane.
Eigen::Matrix<double, 2, 3> pixel_tangent(const OutlineEnd& end, const Eigen::Ref<const Eigen::Matrix3Xd>& positions,
                                          const Camera& camera);

/// Returns the signed distance in pixels from `point` along `normal` to the outline. It takes the closest segment within
/// `reach` pixels whose normal agrees, and writes its number to `segment`. It returns NaN when there is none.
double distance_along_normal(const std::vector<OutlineSegment>& outline, const Eigen::Vector2d& point,
                             const Eigen::Vector2d& normal, double reach, std::size_t& segment);

}  // namespace tissue_stiffness
