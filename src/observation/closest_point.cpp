#include "observation/closest_point.hpp"

#include <Eigen/Geometry>
#include <array>
#include <limits>

#include "meshing/closest_on_triangle.hpp"

namespace tissue_stiffness {

SurfacePoint closest_surface_point(const TetMesh& mesh, const Eigen::Vector3d& query) {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const Eigen::Vector3d a = mesh.nodes.col(mesh.facets(0, f)), b = mesh.nodes.col(mesh.facets(1, f)),
                          c = mesh.nodes.col(mesh.facets(2, f));
    const Eigen::Vector3d point = closest_on_triangle(query, a, b, c);
    const double distance = (query - point).norm();
    if (distance < best.distance) best = {f, point, (b - a).cross(c - a).normalized(), distance};
  }
  return best;
}

// Each facet is tested after Moeller & Trumbore (1997, J. Graph. Tools 2(1)).
SurfacePoint first_surface_point(const TetMesh& mesh, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (int f = 0; f < mesh.facet_count(); ++f) {
    const Eigen::Vector3d a = mesh.nodes.col(mesh.facets(0, f)), ab = mesh.nodes.col(mesh.facets(1, f)) - a,
                          ac = mesh.nodes.col(mesh.facets(2, f)) - a, normal = ab.cross(ac), across = direction.cross(ac);
    if (!(normal.dot(direction) < 0.0)) continue;  // it faces away
    const double determinant = ab.dot(across);
    const Eigen::Vector3d from = origin - a, turned = from.cross(ab);
    const double second = from.dot(across) / determinant, third = direction.dot(turned) / determinant,
                 distance = ac.dot(turned) / determinant;
    if (!(second >= 0.0 && third >= 0.0 && second + third <= 1.0 && distance > 0.0 && distance < best.distance)) continue;
    best = {f, origin + distance * direction, normal.normalized(), distance};
  }
  return best;
}

SurfaceTriangles split_facets(const TetMesh& mesh, const std::vector<int>& facets) {
  static constexpr std::array<std::array<int, 3>, 4> kQuadratic{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  SurfaceTriangles out;
  const int parts = mesh.quadratic() ? 4 : 1;
  out.nodes.resize(3, static_cast<Eigen::Index>(facets.size()) * parts);
  Eigen::Index at = 0;
  for (const int f : facets) {
    for (int k = 0; k < parts; ++k, ++at) {
      for (int i = 0; i < 3; ++i) {
        const int local = mesh.quadratic() ? kQuadratic[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] : i;
        out.nodes(i, at) = mesh.facets(local, f);
      }
      out.facet.push_back(f);
    }
  }
  return out;
}

SurfaceTriangles split_facets(const TetMesh& mesh) {
  std::vector<int> all(static_cast<std::size_t>(mesh.facet_count()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return split_facets(mesh, all);
}

}  // namespace tissue_stiffness
