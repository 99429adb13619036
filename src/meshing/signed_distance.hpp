#pragma once

#include <Eigen/Core>
#include <memory>

#include "meshing/triangle_surface.hpp"

namespace tissue_stiffness {

/// Signed distance of points from a closed surface, negative inside. Its sign is that of the pseudo-normal at the closest
/// point: of a face, of an edge (the sum of both faces' normals) or of a vertex (the sum of the faces' normals, weighted by
/// their angles there). Source: Baerentzen & Aanaes 2005, IEEE TVCG 11(3). A tree of boxes finds the closest triangle.
class SignedDistance {
 public:
  struct Value {
    double distance;            ///< [m]
    Eigen::Vector3d gradient;   ///< unit vector
    Eigen::Matrix3d curvature;  ///< second derivative [1/m]; 0 where the closest point is on a face
  };

  /// The surface must be watertight and oriented outwards, as that of load_surface is.
  explicit SignedDistance(TriangleSurface surface);
  ~SignedDistance();

  /// Returns the distance of a point. For a point that is farther than `far` from the box around the surface, this is the
  /// distance from the box, which is less.
  Value operator()(const Eigen::Vector3d& point, double far) const;
  const Eigen::Vector3d& low() const { return low_; }    ///< corner of that box [m]
  const Eigen::Vector3d& high() const { return high_; }  ///< and the opposite one

 private:
  struct Tree;
  Eigen::Vector3d corner(int triangle, int i) const { return surface_.vertices.col(surface_.triangles(i, triangle)); }
  /// Returns the point of a triangle with these weights of its corners.
  Eigen::Vector3d place(int triangle, const Eigen::Vector3d& weights) const {
    return weights[0] * corner(triangle, 0) + weights[1] * corner(triangle, 1) + weights[2] * corner(triangle, 2);
  }
  void sum_normals();
  Value from_triangle(const Eigen::Vector3d& point, int triangle, const Eigen::Vector3d& weights) const;

  TriangleSurface surface_;
  Eigen::Matrix3Xd face_normals_, vertex_normals_;
  Eigen::Matrix3Xi neighbours_;
  Eigen::Vector3d low_, high_;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace tissue_stiffness
