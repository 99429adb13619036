#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "estimation/replay_recorder.hpp"
#include "observation/closest_point.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

using Cell = std::array<int, 3>;

/// Returns the vertex of each node that the triangles use, -1 elsewhere. Nodes of one cell of this size share a vertex.
std::vector<int> cluster(const TetMesh& mesh, const Eigen::Matrix3Xi& triangles, double size, std::size_t& vertices) {
  std::vector<int> vertex(static_cast<std::size_t>(mesh.node_count()), -1);
  std::map<Cell, int> cells;
  int next = 0;
  for (Eigen::Index i = 0; i < triangles.size(); ++i) {
    int& v = vertex[static_cast<std::size_t>(triangles.data()[i])];
    if (v >= 0) continue;
    if (!(size > 0.0)) {
      v = next++;
      continue;
    }
    const Eigen::Array3i at = (mesh.nodes.col(triangles.data()[i]) / size).array().floor().cast<int>();
    const auto [cell, added] = cells.emplace(Cell{at[0], at[1], at[2]}, next);
    if (added) ++next;
    v = cell->second;
  }
  vertices = static_cast<std::size_t>(next);
  return vertex;
}

}  // namespace

ThinSurface::ThinSurface(const TetMesh& mesh, std::size_t most_vertices) {
  const Eigen::Matrix3Xi all = split_facets(mesh).nodes;
  const double extent = body_size(mesh.nodes);
  std::size_t count = 0;
  std::vector<int> vertex = cluster(mesh, all, 0.0, count);
  for (double cells = 64.0; count > most_vertices; cells *= 0.8) vertex = cluster(mesh, all, extent / cells, count);
  members.resize(count);
  for (std::size_t node = 0; node < vertex.size(); ++node) {
    if (vertex[node] >= 0) members[static_cast<std::size_t>(vertex[node])].push_back(static_cast<int>(node));
  }
  std::vector<Eigen::Vector3i> kept;
  for (Eigen::Index t = 0; t < all.cols(); ++t) {
    const Eigen::Vector3i corners = all.col(t).unaryExpr([&](int node) { return vertex[static_cast<std::size_t>(node)]; });
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) kept.push_back(corners);
  }
  triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t t = 0; t < kept.size(); ++t) triangles.col(static_cast<Eigen::Index>(t)) = kept[t];
}

Eigen::Matrix3Xd ThinSurface::mean(const Eigen::VectorXd& field) const {
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(members.size()));
  for (std::size_t v = 0; v < members.size(); ++v) {
    for (const int node : members[v]) out.col(static_cast<Eigen::Index>(v)) += field.segment<3>(3 * node);
    out.col(static_cast<Eigen::Index>(v)) /= static_cast<double>(members[v].size());
  }
  return out;
}

Eigen::VectorXd ThinSurface::rms(const Eigen::VectorXd& values) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(members.size()));
  for (std::size_t v = 0; v < members.size(); ++v) {
    double sum = 0.0, count = 0.0;
    for (const int node : members[v]) {
      if (std::isfinite(values[node])) sum += values[node] * values[node], count += 1.0;
    }
    out[static_cast<Eigen::Index>(v)] = count > 0.0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

}  // namespace tissue_stiffness
