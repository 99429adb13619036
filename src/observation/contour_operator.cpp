// This sensor sees an outline in an image. Each row is the distance from a measured point, along its normal, to the model's
// outline.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "observation/observation_operator.hpp"
#include "observation/outline.hpp"
#include "tissue_stiffness/types/error.hpp"

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
    size_ = (mesh_.nodes.rowwise().maxCoeff() - mesh_.nodes.rowwise().minCoeff()).norm();
  }

  void check(const Observation& observation) const override {
    if (observation.contour == nullptr || observation.camera == nullptr) {
      throw InputError(settings_.topic, "a contour without its camera", "a contour and the CameraInfo of its image");
    }
  }

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const Contour& contour = *observation.contour;
    const std::vector<OutlineSegment> outline = model_outline(*observation.camera, u);
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
      p.places.col(i) = place(*observation.camera, contour.points.col(i), scale);
      if (!std::isfinite(contour.sigma[i])) continue;
      std::size_t k = 0;
      const double d =
          distance_along_normal(outline, contour.points.col(i), contour.normals.col(i), kReach * size_ / scale, k);
      if (!std::isfinite(d)) continue;
      p.predicted[i] = d * outline[k].scale;
      p.nodes[i] = outline[k].node;
    }
    return p;
  }

  Eigen::Matrix4Xd outline(const Observation& observation, const Eigen::VectorXd& u) const override {
    if (observation.camera == nullptr) return {};
    const std::vector<OutlineSegment> pieces = model_outline(*observation.camera, u);
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
  std::vector<OutlineSegment> model_outline(const Camera& camera, const Eigen::Ref<const Eigen::VectorXd>& u) const {
    VectorPool::Loan scratch(scratch_, u.size());
    Eigen::Map<Eigen::Matrix3Xd> positions(scratch->data(), 3, mesh_.node_count());
    positions = mesh_.nodes + Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, mesh_.node_count());
    if (settings_.projection == ObservationSettings::Projection::silhouette) {
      return silhouette(triangles_, edges_, positions, camera);
    }
    return section_by_plane(triangles_, positions, camera,
                            settings_.segmentation.kind == SegmentationSettings::Kind::cavity);
  }

  static Eigen::Vector3d place(const Camera& camera, const Eigen::Vector2d& pixel, double scale) {
    if (camera.projection == Camera::Projection::slice) {
      return camera.model_from_sensor *
             Eigen::Vector3d((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, 0.0);
    }
    const double depth = scale * camera.fx;
    return camera.model_from_sensor *
           Eigen::Vector3d((pixel.x() - camera.cx) / camera.fx * depth, (pixel.y() - camera.cy) / camera.fy * depth, depth);
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
