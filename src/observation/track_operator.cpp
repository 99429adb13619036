// This sensor follows features of the surface in images. Each gives two rows: how far it has moved from where it was at
// rest, to the right and down in the image, in metres at its depth at rest.
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <mutex>
#include <vector>

#include "meshing/closest_on_triangle.hpp"
#include "observation/closest_point.hpp"
#include "observation/observation_operator.hpp"
#include "observation/outline.hpp"
#include "observation/surface_anchor.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"
#include "types/sensor_ray.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kOnFacet = 1e-6;   // of the body's size: a point that lies on a facet
constexpr double kPoseStep = 1e-4;  // of the body's size, and [rad]

class TrackOperator : public ObservationOperator {
 public:
  TrackOperator(const Model& model, const ObservationSettings& settings)
      : mesh_(model.mesh()),
        topic_(settings.topic),
        noise_(settings.noise),
        size_(body_size(mesh_.nodes)),
        middle_(mesh_.nodes.rowwise().mean()) {}

  void check(const Observation& observation) const override {
    if (observation.tracks == nullptr || observation.camera == nullptr) {
      throw InputError(topic_, "tracks without their camera", "tracks and the CameraInfo of their image");
    }
  }

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const FeatureTracks& tracks = *observation.tracks;
    const Camera& camera = *observation.camera;
    const std::vector<const SurfaceAnchor*> anchors = anchors_of(observation);
    const Eigen::Index n = tracks.size();
    Prediction p;
    p.measured.resize(2 * n);
    p.predicted.resize(2 * n);
    p.sigma.resize(2 * n);
    p.places.resize(3, 2 * n);
    p.nodes.resize(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const SurfaceAnchor& anchor = *anchors[static_cast<std::size_t>(i)];
      const Eigen::Vector3d rest = observation.points.col(i), now = rest + anchor.displacement(mesh_, u);
      const Eigen::Vector2d scale = scale_at(camera, rest), pixel = camera.project(rest), seen = tracks.pixels.col(i);
      p.measured.segment<2>(2 * i) = scale.cwiseProduct(seen - pixel);
      p.predicted.segment<2>(2 * i) = scale.cwiseProduct(camera.project(now) - pixel);
      p.sigma.segment<2>(2 * i) = (tracks.sigma[i] * scale).cwiseMax(noise_);
      p.places.middleCols<2>(2 * i) = place_of(camera, seen, depth_of(camera, rest)).replicate<1, 2>();
      p.nodes.segment<2>(2 * i).setConstant(anchor.node);
    }
    return p;
  }

  std::optional<RowTangent> tangent(const Observation& observation,
                                    const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const Camera& camera = *observation.camera;
    const std::vector<const SurfaceAnchor*> anchors = anchors_of(observation);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < observation.points.cols(); ++i) {
      const SurfaceAnchor& anchor = *anchors[static_cast<std::size_t>(i)];
      const Eigen::Vector3d rest = observation.points.col(i);
      const Eigen::Matrix<double, 2, 3> rows =
          scale_at(camera, rest).asDiagonal() * pixel_tangent(rest + anchor.displacement(mesh_, u), camera);
      for (Eigen::Index k = 0; k < anchor.shape.size(); ++k) {
        for (int r = 0; r < 2; ++r) {
          for (int c = 0; c < 3; ++c)
            entries.emplace_back(2 * i + r, 3 * mesh_.tets(k, anchor.tet) + c, anchor.shape[k] * rows(r, c));
        }
      }
    }
    RowTangent out(2 * observation.points.cols(), u.size());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  // A camera that has another pose sees the same features at rest elsewhere, but they are known there. What it sees of
  // their motion is turned, and enlarged by another depth.
  std::optional<Eigen::MatrixXd> pose_tangent(const Observation& observation,
                                              const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const Camera& camera = *observation.camera;
    const std::vector<const SurfaceAnchor*> anchors = anchors_of(observation);
    Eigen::MatrixXd out(2 * observation.points.cols(), 6);
    for (Eigen::Index i = 0; i < observation.points.cols(); ++i) {
      const Eigen::Vector3d rest = observation.points.col(i),
                            now = rest + anchors[static_cast<std::size_t>(i)]->displacement(mesh_, u);
      const auto seen = [&](const Eigen::Isometry3d& motion) -> Eigen::Vector2d {
        return camera.project(motion * now) - camera.project(motion * rest);
      };
      for (int axis = 0; axis < 6; ++axis) {
        const double step = kPoseStep * (axis < 3 ? size_ : 1.0);
        out.col(axis).segment<2>(2 * i) =
            scale_at(camera, rest).cwiseProduct(seen(moved(axis, step)) - seen(moved(axis, -step))) / (2.0 * step);
      }
    }
    return out;
  }

  Eigen::Matrix4Xd outline(const Observation& observation, const Eigen::VectorXd& u) const override {
    const std::vector<const SurfaceAnchor*> anchors = anchors_of(observation);
    Eigen::Matrix4Xd out(4, observation.points.cols());
    for (Eigen::Index i = 0; i < out.cols(); ++i) {
      const Eigen::Vector3d rest = observation.points.col(i);
      out.col(i) << observation.camera->project(rest),
          observation.camera->project(rest + anchors[static_cast<std::size_t>(i)]->displacement(mesh_, u));
    }
    return out;
  }

  std::vector<int> nodes(const Observation& observation) const override {
    std::vector<int> list;
    for (const SurfaceAnchor* anchor : anchors_of(observation)) {
      const auto tet = mesh_.tets.col(anchor->tet);
      list.insert(list.end(), tet.data(), tet.data() + tet.size());
    }
    return list;
  }

 private:
  using Place = std::array<double, 3>;

  // Returns metres a pixel, to the right and down, at the depth of a point.
  static Eigen::Vector2d scale_at(const Camera& camera, const Eigen::Vector3d& point) {
    const double depth = depth_of(camera, point);
    return {depth / camera.fx, depth / camera.fy};
  }

  // Returns a rigid motion of the body: an offset along an axis, or a rotation about one through its middle.
  Eigen::Isometry3d moved(int axis, double by) const {
    if (axis < 3) return Eigen::Isometry3d(Eigen::Translation3d(by * Eigen::Vector3d::Unit(axis)));
    return Eigen::Translation3d(middle_) * Eigen::AngleAxisd(by, Eigen::Vector3d::Unit(axis - 3)) *
           Eigen::Translation3d(-middle_);
  }

  // The same features come with every frame, so their anchors are kept.
  std::vector<const SurfaceAnchor*> anchors_of(const Observation& observation) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<const SurfaceAnchor*> out;
    for (Eigen::Index i = 0; i < observation.points.cols(); ++i) {
      const Place key{observation.points(0, i), observation.points(1, i), observation.points(2, i)};
      auto known = anchors_.find(key);
      if (known == anchors_.end()) {
        const Eigen::Vector3d point = observation.points.col(i);
        known = anchors_.emplace(key, anchor_on(mesh_, facet_of(point, observation.tracks->facets[i]), point)).first;
      }
      out.push_back(&known->second);
    }
    return out;
  }

  // The facet is that of the recording's mesh, and this one may be finer.
  int facet_of(const Eigen::Vector3d& point, int facet) const {
    if (facet < mesh_.facet_count()) {
      const auto corner = [&](int i) -> Eigen::Vector3d { return mesh_.nodes.col(mesh_.facets(i, facet)); };
      if ((closest_on_triangle(point, corner(0), corner(1), corner(2)) - point).norm() < kOnFacet * size_) return facet;
    }
    return closest_surface_point(mesh_, point).facet;
  }

  const TetMesh& mesh_;
  std::string topic_;
  double noise_, size_;
  Eigen::Vector3d middle_;
  mutable std::mutex mutex_;
  mutable std::map<Place, SurfaceAnchor> anchors_;  ///< by the place at rest
};

}  // namespace

std::unique_ptr<ObservationOperator> make_track_operator(const Model& model, const ObservationSettings& settings) {
  return std::make_unique<TrackOperator>(model, settings);
}

}  // namespace tissue_stiffness
