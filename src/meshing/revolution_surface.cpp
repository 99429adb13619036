#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "meshing/bodies.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFineSteps = 2000;

// Returns the angles that divide the profile into `parts` pieces of equal length.
std::vector<double> equal_arcs(const std::vector<double>& lengths, int parts) {
  std::vector<double> angles;
  std::size_t fine = 1;
  for (int part = 1; part < parts; ++part) {
    const double target = lengths.back() * part / parts;
    while (lengths[fine] < target) ++fine;
    const double share = (target - lengths[fine - 1]) / (lengths[fine] - lengths[fine - 1]);
    angles.push_back(M_PI * (static_cast<double>(fine - 1) + share) / kFineSteps);
  }
  return angles;
}

std::vector<double> arc_lengths(const RevolutionProfile& profile) {
  std::vector<double> lengths = {0.0};
  for (int i = 1; i <= kFineSteps; ++i) {
    const Eigen::Vector2d step = profile.meridian(M_PI * i / kFineSteps) - profile.meridian(M_PI * (i - 1) / kFineSteps);
    lengths.push_back(lengths.back() + step.norm());
  }
  return lengths;
}

struct Ring {
  int first, count;
  double phase;  // of the first vertex, in turns
  double turn(int i) const { return phase + static_cast<double>(i) / count; }
  int vertex(int i) const { return first + i % count; }
};

// Adds triangles between two rings, always along the diagonal that turns less.
void stitch(const Ring& upper, const Ring& lower, std::vector<Eigen::Vector3i>& triangles) {
  int i = 0, j = 0;
  while (i < upper.count || j < lower.count) {
    const double along_upper = std::abs(upper.turn(i + 1) - lower.turn(j));
    const double along_lower = std::abs(lower.turn(j + 1) - upper.turn(i));
    if (j == lower.count || (i < upper.count && along_upper < along_lower)) {
      triangles.emplace_back(upper.vertex(i), lower.vertex(j), upper.vertex(i + 1));
      ++i;
    } else {
      triangles.emplace_back(upper.vertex(i), lower.vertex(j), lower.vertex(j + 1));
      ++j;
    }
  }
}

void close_pole(int pole, const Ring& ring, bool top, std::vector<Eigen::Vector3i>& triangles) {
  for (int i = 0; i < ring.count; ++i) {
    if (top)
      triangles.emplace_back(pole, ring.vertex(i), ring.vertex(i + 1));
    else
      triangles.emplace_back(pole, ring.vertex(i + 1), ring.vertex(i));
  }
}

}  // namespace

TriangleSurface revolution_surface(const RevolutionProfile& profile, double edge_length) {
  const std::vector<double> lengths = arc_lengths(profile);
  const int parts = std::max(4, static_cast<int>(std::lround(lengths.back() / (edge_length * std::sqrt(0.75)))));
  const Eigen::Vector3d axis = profile.axis(), u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Eigen::Vector3d> vertices = {profile.centre() + profile.radius(0.0) * axis};
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Ring> rings;
  for (const double angle : equal_arcs(lengths, parts)) {
    const Eigen::Vector2d at = profile.meridian(angle);
    const int count = std::max(5, static_cast<int>(std::lround(2.0 * M_PI * at.x() / edge_length)));
    const double phase = rings.size() % 2 == 0 ? 0.0 : 0.5 / count;
    rings.push_back({static_cast<int>(vertices.size()), count, phase});
    for (int i = 0; i < count; ++i) {
      const double turn = 2.0 * M_PI * rings.back().turn(i);
      vertices.push_back(profile.centre() + at.y() * axis + at.x() * (std::cos(turn) * u + std::sin(turn) * v));
    }
  }
  vertices.push_back(profile.centre() - profile.radius(M_PI) * axis);
  close_pole(0, rings.front(), true, triangles);
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) stitch(rings[k], rings[k + 1], triangles);
  close_pole(static_cast<int>(vertices.size()) - 1, rings.back(), false, triangles);

  TriangleSurface surface{Eigen::Matrix3Xd(3, vertices.size()), Eigen::Matrix3Xi(3, triangles.size())};
  for (std::size_t i = 0; i < vertices.size(); ++i) surface.vertices.col(static_cast<Eigen::Index>(i)) = vertices[i];
  for (std::size_t i = 0; i < triangles.size(); ++i) surface.triangles.col(static_cast<Eigen::Index>(i)) = triangles[i];
  return surface;
}

}  // namespace tissue_stiffness
