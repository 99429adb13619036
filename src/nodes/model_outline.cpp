#include "nodes/model_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue_stiffness/meshing/build_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpacing = 4.0;  // [pixel]

}  // namespace

ModelOutline::ModelOutline(const ModelSettings& settings, const ObservationSettings& observation, const TetMesh& mesh)
    : slice_(observation.projection == ObservationSettings::Projection::slice),
      cavity_(observation.segmentation.kind == SegmentationSettings::Kind::cavity),
      triangles_(observation.region.empty()
                     ? split_facets(mesh)
                     : split_facets(mesh, resolve_regions(settings, mesh).at(observation.region).facets)),
      edges_(surface_edges(triangles_)) {}

Contour ModelOutline::seen_by(const Camera& camera, const Eigen::Matrix3Xd& positions) const {
  const std::vector<OutlineSegment> pieces =
      slice_ ? section_by_plane(triangles_, positions, camera, cavity_) : silhouette(triangles_, edges_, positions, camera);
  std::vector<Eigen::Vector4d> rows;  // point and normal
  for (const OutlineSegment& piece : pieces) {
    if (!piece.from.allFinite() || !piece.to.allFinite()) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil((piece.to - piece.from).norm() / kSpacing)));
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d point = piece.from + (piece.to - piece.from) * i / steps;
      rows.emplace_back(point.x(), point.y(), piece.normal.x(), piece.normal.y());
    }
    rows.emplace_back(Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  Contour out;
  out.width = camera.width;
  out.height = camera.height;
  out.closed = false;
  const auto n = static_cast<Eigen::Index>(rows.size());
  out.points.resize(2, n);
  out.normals.resize(2, n);
  out.sigma = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    out.points.col(i) = rows[static_cast<std::size_t>(i)].head<2>();
    out.normals.col(i) = rows[static_cast<std::size_t>(i)].tail<2>();
  }
  return out;
}

}  // namespace tissue_stiffness
