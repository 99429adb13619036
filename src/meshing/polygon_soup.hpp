#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "meshing/file_cursor.hpp"
#include "meshing/triangle_surface.hpp"

namespace tissue_stiffness {

/// Vertices and polygons as a file lists them.
class PolygonSoup {
 public:
  void add_vertex(const Eigen::Vector3d& point) { vertices_.push_back(point); }
  long long vertex_count() const { return static_cast<long long>(vertices_.size()); }

  /// Cuts a polygon into a fan of triangles. Corners count from 0.
  void add_polygon(const std::vector<long long>& corners) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      triangles_.push_back({corners[0], corners[i], corners[i + 1]});
    }
  }

  /// Returns the surface. Fails at the cursor for a corner that is no vertex.
  TriangleSurface surface(const FileCursor& in) const {
    if (vertex_count() > std::numeric_limits<int>::max()) in.fail("too many vertices", "2^31 at most");
    TriangleSurface out;
    out.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    out.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < vertices_.size(); ++i) out.vertices.col(static_cast<Eigen::Index>(i)) = vertices_[i];
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        const long long vertex = triangles_[t][static_cast<std::size_t>(corner)];
        if (vertex < 0 || vertex >= vertex_count()) {
          in.fail("vertex " + std::to_string(vertex) + " in triangle " + std::to_string(t),
                  "vertices 0 to " + std::to_string(vertex_count() - 1));
        }
        out.triangles(corner, static_cast<Eigen::Index>(t)) = static_cast<int>(vertex);
      }
    }
    return out;
  }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<long long, 3>> triangles_;
};

}  // namespace tissue_stiffness
