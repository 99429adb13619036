#include "observation/closest_point.hpp"

#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace tissue_stiffness {

Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

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
