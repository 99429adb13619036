#include "meshing/triangle_surface.hpp"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "meshing/file_cursor.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

struct Side {
  std::array<int, 2> key;  // ascending vertices
  int triangle, local;
};

std::vector<Side> sorted_sides(const TriangleSurface& surface) {
  std::vector<Side> sides;
  sides.reserve(3 * static_cast<std::size_t>(surface.triangle_count()));
  for (int t = 0; t < surface.triangle_count(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(surface.triangles(i, t), surface.triangles((i + 1) % 3, t));
      sides.push_back({{low, high}, t, i});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.key != b.key ? a.key < b.key : a.triangle < b.triangle; });
  return sides;
}

// Returns for each vertex the first one within the tolerance.
std::vector<int> representatives(const Eigen::Matrix3Xd& vertices, double tolerance) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  const Eigen::Vector3d centre = vertices.rowwise().mean();
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    const Eigen::Vector3f p = (vertices.col(i) - centre).cast<float>();
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud);
  std::vector<int> first(static_cast<std::size_t>(vertices.cols()), -1);
  std::vector<int> neighbours;
  std::vector<float> squared;
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    if (first[static_cast<std::size_t>(i)] >= 0) continue;
    tree.radiusSearch(i, tolerance, neighbours, squared);
    neighbours.push_back(i);
    for (const int j : neighbours) {
      if (first[static_cast<std::size_t>(j)] < 0) first[static_cast<std::size_t>(j)] = i;
    }
  }
  return first;
}

bool same_direction(const TriangleSurface& surface, int a, int side_a, int b, const Eigen::Matrix3Xi& neighbours) {
  for (int side_b = 0; side_b < 3; ++side_b) {
    if (neighbours(side_b, b) == a && surface.triangles(side_b, b) == surface.triangles(side_a, a) &&
        surface.triangles((side_b + 1) % 3, b) == surface.triangles((side_a + 1) % 3, a)) {
      return true;
    }
  }
  return false;
}

// Calls visit(from, side, to, seen) for every side of each triangle in the shell of the first one.
template <typename Visit>
void walk_shell(const Eigen::Matrix3Xi& neighbours, int start, std::vector<int>& shell_of, int shell, Visit visit) {
  std::vector<int> stack = {start};
  shell_of[static_cast<std::size_t>(start)] = shell;
  while (!stack.empty()) {
    const int triangle = stack.back();
    stack.pop_back();
    for (int side = 0; side < 3; ++side) {
      const int next = neighbours(side, triangle);
      const bool seen = shell_of[static_cast<std::size_t>(next)] >= 0;
      visit(triangle, side, next, seen);
      if (seen) continue;
      shell_of[static_cast<std::size_t>(next)] = shell;
      stack.push_back(next);
    }
  }
}

double cone_volume(const TriangleSurface& surface, int t) {
  return triangle_area_vector(surface, t).dot(surface.vertices.col(surface.triangles(0, t))) / 3.0;
}

}  // namespace

TriangleSurface weld(const TriangleSurface& surface, double tolerance) {
  TriangleSurface result;
  if (surface.triangle_count() == 0) return result;
  const std::vector<int> first = representatives(surface.vertices, tolerance);
  std::vector<int> number(first.size(), -1);
  result.vertices.resize(3, surface.vertices.cols());
  result.triangles.resize(3, surface.triangles.cols());
  int vertices = 0, triangles = 0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    Eigen::Vector3i corners;
    for (int i = 0; i < 3; ++i) corners[i] = first[static_cast<std::size_t>(surface.triangles(i, t))];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (int i = 0; i < 3; ++i) {
      int& to = number[static_cast<std::size_t>(corners[i])];
      if (to < 0) {
        to = vertices++;
        result.vertices.col(to) = surface.vertices.col(corners[i]);
      }
      corners[i] = to;
    }
    result.triangles.col(triangles++) = corners;
  }
  result.vertices.conservativeResize(3, vertices);
  result.triangles.conservativeResize(3, triangles);
  return result;
}

void check_watertight(const TriangleSurface& surface, const std::string& where) {
  if (surface.triangle_count() == 0) throw InputError(where, "no triangles", "a closed surface");
  for (int i = 0; i < surface.vertex_count(); ++i) {
    if (surface.vertices.col(i).allFinite()) continue;
    throw InputError(where, "vertex " + std::to_string(i) + " with a coordinate that is not finite", "finite numbers");
  }
  const std::vector<Side> sides = sorted_sides(surface);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    if (end - begin == 2) continue;
    const std::string edge = "an edge from " + format_point(surface.vertices.col(sides[begin].key[0])) + " to " +
                             format_point(surface.vertices.col(sides[begin].key[1]));
    if (end - begin == 1) throw InputError(where, "an open surface, " + edge + " with one triangle", "a closed surface");
    throw InputError(where, "a non-manifold surface, " + edge + " with " + std::to_string(end - begin) + " triangles",
                     "two triangles an edge");
  }
}

Eigen::Matrix3Xi triangle_neighbours(const TriangleSurface& surface) {
  Eigen::Matrix3Xi neighbours(3, surface.triangle_count());
  const std::vector<Side> sides = sorted_sides(surface);
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    neighbours(sides[i].local, sides[i].triangle) = sides[i + 1].triangle;
    neighbours(sides[i + 1].local, sides[i + 1].triangle) = sides[i].triangle;
  }
  return neighbours;
}

std::vector<int> shells(const TriangleSurface& surface) {
  const Eigen::Matrix3Xi neighbours = triangle_neighbours(surface);
  std::vector<int> shell_of(static_cast<std::size_t>(surface.triangle_count()), -1);
  int count = 0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    if (shell_of[static_cast<std::size_t>(t)] < 0) walk_shell(neighbours, t, shell_of, count++, [](int, int, int, bool) {});
  }
  return shell_of;
}

void orient_outwards(TriangleSurface& surface, const std::string& where) {
  Eigen::Matrix3Xi neighbours = triangle_neighbours(surface);
  const auto flip = [&surface, &neighbours](int t) {
    std::swap(surface.triangles(1, t), surface.triangles(2, t));
    std::swap(neighbours(0, t), neighbours(2, t));
  };
  std::vector<int> shell_of(static_cast<std::size_t>(surface.triangle_count()), -1);
  int count = 0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    if (shell_of[static_cast<std::size_t>(t)] >= 0) continue;
    walk_shell(neighbours, t, shell_of, count++, [&](int from, int side, int to, bool seen) {
      if (!same_direction(surface, from, side, to, neighbours)) return;
      if (seen) {
        throw InputError(where,
                         "a one-sided surface at " + format_point(surface.vertices.col(surface.triangles(side, from))),
                         "a surface with an inside and an outside");
      }
      flip(to);
    });
  }
  std::vector<double> volume(static_cast<std::size_t>(count), 0.0);
  for (int t = 0; t < surface.triangle_count(); ++t) {
    volume[static_cast<std::size_t>(shell_of[static_cast<std::size_t>(t)])] += cone_volume(surface, t);
  }
  for (int t = 0; t < surface.triangle_count(); ++t) {
    if (volume[static_cast<std::size_t>(shell_of[static_cast<std::size_t>(t)])] < 0.0) flip(t);
  }
}

Eigen::Vector3d triangle_area_vector(const TriangleSurface& surface, int t) {
  const Eigen::Vector3d x0 = surface.vertices.col(surface.triangles(0, t));
  const Eigen::Vector3d a = surface.vertices.col(surface.triangles(1, t)) - x0;
  const Eigen::Vector3d b = surface.vertices.col(surface.triangles(2, t)) - x0;
  return 0.5 * a.cross(b);
}

double winding_number(const TriangleSurface& surface, const Eigen::Vector3d& point) {
  double angle = 0.0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const Eigen::Vector3d a = surface.vertices.col(surface.triangles(0, t)) - point;
    const Eigen::Vector3d b = surface.vertices.col(surface.triangles(1, t)) - point;
    const Eigen::Vector3d c = surface.vertices.col(surface.triangles(2, t)) - point;
    const double na = a.norm(), nb = b.norm(), nc = c.norm();
    angle += 2.0 * std::atan2(a.cross(b).dot(c), na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
  }
  return angle / (4.0 * M_PI);
}

double enclosed_volume(const TriangleSurface& surface) {
  const std::vector<int> shell_of = shells(surface);
  const int count = 1 + *std::max_element(shell_of.begin(), shell_of.end());
  double total = 0.0;
  for (int shell = 0; shell < count; ++shell) {
    TriangleSurface others{surface.vertices, Eigen::Matrix3Xi(3, surface.triangle_count())};
    double volume = 0.0;
    int outer = 0, sample = 0;
    for (int t = 0; t < surface.triangle_count(); ++t) {
      if (shell_of[static_cast<std::size_t>(t)] == shell) {
        volume += cone_volume(surface, t);
        sample = surface.triangles(0, t);
      } else {
        others.triangles.col(outer++) = surface.triangles.col(t);
      }
    }
    others.triangles.conservativeResize(3, outer);
    const long depth = std::lround(winding_number(others, surface.vertices.col(sample)));
    total += (depth % 2 == 0 ? 1.0 : -1.0) * std::abs(volume);
  }
  return total;
}

}  // namespace tissue_stiffness
