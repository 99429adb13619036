#include "meshing/planar_facets.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "meshing/polygon.hpp"

namespace tissue_stiffness {
namespace {

// If planes meet at less than this sine, they define no straight edge, and its vertices are kept.
constexpr double kMinSine = 0.02;

struct Patches {
  std::vector<int> of_triangle;
  std::vector<Eigen::Vector3d> normals, points;  // of each patch's plane
  std::vector<int> sizes;                        // triangles
};

// Grows patches from the largest triangles, because their planes are known best.
Patches grow_patches(const TriangleSurface& surface, const Eigen::Matrix3Xi& neighbours, double tolerance) {
  Eigen::Matrix3Xd areas(3, surface.triangle_count());
  for (int t = 0; t < surface.triangle_count(); ++t) areas.col(t) = triangle_area_vector(surface, t);
  const Eigen::VectorXd sizes = areas.colwise().norm();
  std::vector<int> by_area(static_cast<std::size_t>(surface.triangle_count()));
  std::iota(by_area.begin(), by_area.end(), 0);
  std::stable_sort(by_area.begin(), by_area.end(), [&sizes](int a, int b) { return sizes[a] > sizes[b]; });

  Patches patches;
  patches.of_triangle.assign(by_area.size(), -1);
  for (const int seed : by_area) {
    if (patches.of_triangle[static_cast<std::size_t>(seed)] >= 0) continue;
    const Eigen::Vector3d normal = areas.col(seed).normalized(), point = surface.vertices.col(surface.triangles(0, seed));
    const auto belongs = [&](int t) {
      for (int i = 0; i < 3; ++i) {
        const int vertex = surface.triangles(i, t);
        if (std::abs(normal.dot(surface.vertices.col(vertex) - point)) > tolerance) return false;
      }
      return areas.col(t).dot(normal) >= 0.5 * sizes[t] || sizes[t] < tolerance * tolerance;
    };
    const auto patch = static_cast<int>(patches.sizes.size());
    std::vector<int> stack = {seed};
    patches.of_triangle[static_cast<std::size_t>(seed)] = patch;
    int size = 0;
    for (; !stack.empty(); ++size) {
      const int t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const int next = neighbours(i, t);
        if (patches.of_triangle[static_cast<std::size_t>(next)] >= 0 || !belongs(next)) continue;
        patches.of_triangle[static_cast<std::size_t>(next)] = patch;
        stack.push_back(next);
      }
    }
    patches.normals.push_back(normal);
    patches.points.push_back(point);
    patches.sizes.push_back(size);
  }
  return patches;
}

// Edges between patches that meet at a vertex.
struct VertexFeatures {
  std::vector<int> ends;     // other ends of the feature edges
  std::vector<int> patches;  // all patches at the vertex
};

class Merger {
 public:
  Merger(const TriangleSurface& surface, double tolerance)
      : surface_(surface),
        neighbours_(triangle_neighbours(surface)),
        patches_(grow_patches(surface, neighbours_, tolerance)),
        features_(static_cast<std::size_t>(surface.vertex_count())),
        tolerance_(tolerance) {
    for (int t = 0; t < surface.triangle_count(); ++t) {
      for (int side = 0; side < 3; ++side) add_features(side, t);
    }
  }

  PlanarFacets merge() const {
    PlanarFacets result;
    for (const Eigen::Vector3d& normal : patches_.normals) result.facets.push_back({{}, normal});
    std::vector<int> number(features_.size(), -1);
    result.vertices.resize(3, surface_.vertex_count());
    int count = 0;
    Eigen::Matrix<bool, 3, Eigen::Dynamic> done =
        Eigen::Matrix<bool, 3, Eigen::Dynamic>::Zero(3, surface_.triangle_count());
    for (int t = 0; t < surface_.triangle_count(); ++t) {
      for (int side = 0; side < 3; ++side) {
        if (done(side, t) || !feature(side, t)) continue;
        std::vector<int> loop = trace(side, t, done);
        if (loop.size() < 3) return unmerged();
        for (int& vertex : loop) {
          int& to = number[static_cast<std::size_t>(vertex)];
          if (to < 0) {
            to = count++;
            result.vertices.col(to) = snapped(vertex);
          }
          vertex = to;
        }
        result.facets[static_cast<std::size_t>(patch(t))].loops.push_back(std::move(loop));
      }
    }
    result.vertices.conservativeResize(3, count);
    return result;
  }

 private:
  int patch(int t) const { return patches_.of_triangle[static_cast<std::size_t>(t)]; }
  bool feature(int side, int t) const { return patch(neighbours_(side, t)) != patch(t); }
  const Eigen::Vector3d& normal(int patch) const { return patches_.normals[static_cast<std::size_t>(patch)]; }

  void add_features(int side, int t) {
    const int from = surface_.triangles(side, t);
    VertexFeatures& at = features_[static_cast<std::size_t>(from)];
    if (std::find(at.patches.begin(), at.patches.end(), patch(t)) == at.patches.end()) at.patches.push_back(patch(t));
    if (feature(side, t)) at.ends.push_back(surface_.triangles((side + 1) % 3, t));
  }

  // Follows the outline of a patch from one of its edges on, along the patch's triangles around each vertex.
  std::vector<int> trace(int side, int t, Eigen::Matrix<bool, 3, Eigen::Dynamic>& done) const {
    std::vector<int> loop;
    while (!done(side, t)) {
      done(side, t) = true;
      if (!straight(surface_.triangles(side, t))) loop.push_back(surface_.triangles(side, t));
      const int pivot = surface_.triangles((side + 1) % 3, t);
      side = (side + 1) % 3;
      while (!feature(side, t)) {
        t = neighbours_(side, t);
        side = 0;
        while (surface_.triangles(side, t) != pivot) ++side;
      }
    }
    return loop;
  }

  bool straight(int vertex) const {
    const VertexFeatures& at = features_[static_cast<std::size_t>(vertex)];
    if (at.ends.size() != 2 || at.patches.size() != 2) return false;
    if (normal(at.patches[0]).cross(normal(at.patches[1])).norm() < kMinSine) return false;
    const Eigen::Vector3d x = surface_.vertices.col(vertex);
    const Eigen::Vector3d a = surface_.vertices.col(at.ends[0]) - x, b = surface_.vertices.col(at.ends[1]) - x;
    return a.dot(b) < 0.0 && a.cross(b).norm() <= 4.0 * tolerance_ / kMinSine * (b - a).norm();
  }

  // Returns the nearest point on the planes of all patches of several triangles.
  Eigen::Vector3d snapped(int vertex) const {
    const VertexFeatures& at = features_[static_cast<std::size_t>(vertex)];
    const Eigen::Vector3d x = surface_.vertices.col(vertex);
    Eigen::MatrixX3d normals(0, 3);
    Eigen::VectorXd distances(0);
    for (const int p : at.patches) {
      if (patches_.sizes[static_cast<std::size_t>(p)] < 2) continue;
      normals.conservativeResize(normals.rows() + 1, 3);
      distances.conservativeResize(distances.size() + 1);
      normals.bottomRows(1) = normal(p).transpose();
      distances.tail(1)[0] = normal(p).dot(patches_.points[static_cast<std::size_t>(p)] - x);
    }
    if (normals.rows() == 0) return x;
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(normals, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(kMinSine);
    const Eigen::Vector3d step = svd.solve(distances);
    return step.norm() < 10.0 * tolerance_ / kMinSine ? Eigen::Vector3d(x + step) : x;
  }

  PlanarFacets unmerged() const {
    PlanarFacets result{surface_.vertices, {}};
    for (int t = 0; t < surface_.triangle_count(); ++t) {
      const Eigen::Vector3i corners = surface_.triangles.col(t);
      result.facets.push_back({{{corners[0], corners[1], corners[2]}}, triangle_area_vector(surface_, t).normalized()});
    }
    return result;
  }

  const TriangleSurface& surface_;
  Eigen::Matrix3Xi neighbours_;
  Patches patches_;
  std::vector<VertexFeatures> features_;
  double tolerance_;
};

}  // namespace

void subdivide_edges(PlanarFacets& facets, double length) {
  std::map<std::pair<int, int>, std::vector<int>> inner;  // points from the lower end to the higher
  std::vector<Eigen::Vector3d> added;
  const auto first = static_cast<int>(facets.vertices.cols());
  const auto cut = [&](int a, int b) {
    const auto [entry, fresh] = inner.try_emplace(std::minmax(a, b));
    if (fresh) {
      const Eigen::Vector3d from = facets.vertices.col(entry->first.first), to = facets.vertices.col(entry->first.second);
      const auto parts = static_cast<int>(std::ceil((to - from).norm() / length * (1.0 - 1e-9)));
      for (int i = 1; i < parts; ++i) {
        entry->second.push_back(first + static_cast<int>(added.size()));
        added.push_back(from + (to - from) * i / parts);
      }
    }
    std::vector<int> points = entry->second;
    if (a > b) std::reverse(points.begin(), points.end());
    return points;
  };
  for (PlanarFacets::Facet& facet : facets.facets) {
    for (std::vector<int>& loop : facet.loops) {
      std::vector<int> finer;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::vector<int> points = cut(loop[i], loop[(i + 1) % loop.size()]);
        finer.push_back(loop[i]);
        finer.insert(finer.end(), points.begin(), points.end());
      }
      loop = std::move(finer);
    }
  }
  facets.vertices.conservativeResize(3, first + static_cast<int>(added.size()));
  for (std::size_t i = 0; i < added.size(); ++i) facets.vertices.col(first + static_cast<int>(i)) = added[i];
}

PlanarFacets merge_coplanar(const TriangleSurface& surface, double tolerance) {
  return Merger(surface, tolerance).merge();
}

TriangleSurface triangulate(const PlanarFacets& facets) {
  std::vector<Eigen::Vector3i> triangles;
  for (const PlanarFacets::Facet& facet : facets.facets) {
    const Eigen::Vector3d u = facet.normal.unitOrthogonal(), v = facet.normal.cross(u);
    Eigen::Matrix2Xd points(2, facets.vertices.cols());
    points << u.transpose() * facets.vertices, v.transpose() * facets.vertices;
    const std::vector<Eigen::Vector3i> part = cut_ears(points, facet.loops);
    triangles.insert(triangles.end(), part.begin(), part.end());
  }
  TriangleSurface surface{facets.vertices, Eigen::Matrix3Xi(3, static_cast<Eigen::Index>(triangles.size()))};
  for (std::size_t t = 0; t < triangles.size(); ++t) surface.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return surface;
}

}  // namespace tissue_stiffness
