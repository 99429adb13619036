// This sensor sees an outline in an image. Each row is the distance from a measured point, along its normal, to the model's
// outline.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "observation/observation_operator.hpp"
#include "observation/outline.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"
#include "types/sensor_ray.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kReach = 0.25;  // of the body's size: largest distance between model and measurement

class ContourOperator : public ObservationOperator {
 public:
  ContourOperator(const Model& model, const ObservationSettings& settings) : mesh_(model.mesh()), settings_(settings) {
    if (settings.region.empty()) {
      triangles_ = split_facets(mesh_);
    } else {
      const auto region = model.body().regions.find(settings.region);
      if (region == model.body().regions.end() || region->second.facets.empty()) {
        throw InputError(model.settings().name + ": observations: contour: region", "'" + settings.region + "'",
                         "a region that holds boundary facets");
      }
      triangles_ = split_facets(mesh_, region->second.facets);
    }
    edges_ = surface_edges(triangles_);
    size_ = body_size(mesh_.nodes);
  }

  void check(const Observation& observation) const override {
    if (observation.contour == nullptr || observation.camera == nullptr) {
      throw InputError(settings_.topic, "a contour without its camera", "a contour and the CameraInfo of its image");
    }
  }

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const Contour& contour = *observation.contour;
    VectorPool::Loan scratch(scratch_, u.size());
    const std::vector<OutlineSegment> outline = model_outline(*observation.camera, moved_nodes(u, *scratch));
    const double scale = outline.empty() ? std::numeric_limits<double>::quiet_NaN() : outline.front().scale;
    const Eigen::Index n = contour.size();
    Prediction p;
    p.measured = Eigen::VectorXd::Zero(n);
    p.predicted = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
    p.sigma.resize(n);
    p.places.resize(3, n);
    p.nodes = Eigen::VectorXi::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      p.sigma[i] = std::max(settings_.noise, contour.sigma[i] * scale);
      p.places.col(i) = place_of(*observation.camera, contour.points.col(i), scale * observation.camera->fx);
      std::size_t k = 0;
      const double d = distance(contour, i, outline, k);
      if (!std::isfinite(d)) continue;
      p.predicted[i] = d * outline[k].scale;
      p.nodes[i] = outline[k].from_end.node;
    }
    return p;
  }

  // Where a point's normal meets a segment at a share r, both ends move the distance d along the normal m by their own
  // motion across the segment: dd = e . ((1 - r) d from + r d to) / (e . m), with e across it.
  std::optional<RowTangent> tangent(const Observation& observation,
                                    const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const Contour& contour = *observation.contour;
    const Camera& camera = *observation.camera;
    VectorPool::Loan scratch(scratch_, u.size());
    const Positions at = moved_nodes(u, *scratch);
    const std::vector<OutlineSegment> outline = model_outline(camera, at);
    const Eigen::RowVector3d depth = camera.model_from_sensor.linear().col(2).transpose() / camera.fx;
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < contour.size(); ++i) {
      std::size_t k = 0;
      const double d = distance(contour, i, outline, k);
      if (!std::isfinite(d)) continue;
      const OutlineSegment& s = outline[k];
      const auto add = [&](int node, double share, const Eigen::RowVector3d& row) {
        for (int a = 0; a < 3; ++a) entries.emplace_back(i, 3 * node + a, share * row[a]);
      };
      const Eigen::Vector2d edge = s.to - s.from, m = contour.normals.col(i), hit = contour.points.col(i) + d * m;
      const double r = (hit - s.from).dot(edge) / edge.squaredNorm();
      const Eigen::RowVector2d across(edge.y(), -edge.x());
      const Eigen::RowVector2d gain = s.scale / across.dot(m) * across;
      for (const auto& [end, share] : {std::make_pair(s.from_end, 1.0 - r), std::make_pair(s.to_end, r)}) {
        const Eigen::RowVector3d row = gain * pixel_tangent(end, at, camera);
        add(end.node, share * (1.0 - end.share), row);
        if (end.share > 0.0) add(end.other, share * end.share, row);
        if (camera.projection == Camera::Projection::pinhole) add(end.node, 0.5 * d, depth);
      }
    }
    RowTangent out(contour.size(), u.size());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  Eigen::Matrix4Xd outline(const Observation& observation, const Eigen::VectorXd& u) const override {
    if (observation.camera == nullptr) return {};
    VectorPool::Loan scratch(scratch_, u.size());
    const std::vector<OutlineSegment> pieces = model_outline(*observation.camera, moved_nodes(u, *scratch));
    Eigen::Matrix4Xd out(4, static_cast<Eigen::Index>(pieces.size()));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      out.col(static_cast<Eigen::Index>(i)) << pieces[i].from, pieces[i].to;
    }
    return out;
  }

  std::vector<int> nodes(const Observation&) const override {
    return {triangles_.nodes.data(), triangles_.nodes.data() + triangles_.nodes.size()};
  }

 private:
  using Positions = Eigen::Map<const Eigen::Matrix3Xd>;
  Positions moved_nodes(const Eigen::Ref<const Eigen::VectorXd>& u, Eigen::VectorXd& out) const {
    out = Eigen::Map<const Eigen::VectorXd>(mesh_.nodes.data(), mesh_.nodes.size()) + u;
    return {out.data(), 3, mesh_.node_count()};
  }

  std::vector<OutlineSegment> model_outline(const Camera& camera, const Positions& at) const {
    if (settings_.projection == ObservationSettings::Projection::silhouette) {
      return silhouette(triangles_, edges_, at, camera);
    }
    return section_by_plane(triangles_, at, camera, settings_.segmentation.kind == SegmentationSettings::Kind::cavity);
  }

  // Returns the distance [pixel] from a measured point to the model's outline, and its segment; NaN where there is none.
  double distance(const Contour& contour, Eigen::Index i, const std::vector<OutlineSegment>& outline,
                  std::size_t& segment) const {
    if (outline.empty() || !std::isfinite(contour.sigma[i])) return std::numeric_limits<double>::quiet_NaN();
    return distance_along_normal(outline, contour.points.col(i), contour.normals.col(i),
                                 kReach * size_ / outline.front().scale, segment);
  }

  const TetMesh& mesh_;
  ObservationSettings settings_;
  SurfaceTriangles triangles_;
  std::vector<SurfaceEdge> edges_;
  double size_ = 0.0;
  mutable VectorPool scratch_;  ///< nodes' positions, for each prediction under way
};

}  // namespace

std::unique_ptr<ObservationOperator> make_contour_operator(const Model& model, const ObservationSettings& settings) {
  return std::make_unique<ContourOperator>(model, settings);
}

}  // namespace tissue_stiffness
