// Surface points have no identity. Each row is the distance along the normal of the closest place on the displaced surface.
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <limits>

#include "meshing/closest_on_triangle.hpp"
#include "observation/closest_point.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kCandidates = 8;  // triangles tested for each point, those with the nearest centroids

class PointOperator : public ObservationOperator {
 public:
  PointOperator(const Model& model, const ObservationSettings& settings)
      : mesh_(model.mesh()), noise_(settings.noise), triangles_(split_facets(model.mesh())) {}

  void check(const Observation&) const override {}

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const std::vector<Foot> feet = find_feet(observation.points, u);
    const Eigen::Index n = observation.points.cols();
    Prediction p;
    p.measured = Eigen::VectorXd::Zero(n);
    p.predicted = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
    p.sigma = Eigen::VectorXd::Constant(n, noise_);
    p.places = observation.points;
    p.nodes = Eigen::VectorXi::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Foot& foot = feet[static_cast<std::size_t>(i)];
      if (foot.triangle < 0) continue;
      p.predicted[i] = -foot.normal.dot(foot.offset);
      p.nodes[i] = triangles_.nodes(0, foot.triangle);
    }
    return p;
  }

  // The foot moves with the surface. What it slides along the triangle does not change the distance along the normal n. The
  // offset from a foot on an edge has a part t across the normal, and the turning normal changes the distance there:
  // dn . t = t . (da x b + a x db) / |a x b|, with the edges a and b of the triangle.
  std::optional<RowTangent> tangent(const Observation& observation,
                                    const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const std::vector<Foot> feet = find_feet(observation.points, u);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const Foot& foot = feet[i];
      if (foot.triangle < 0) continue;
      const Eigen::Matrix3d x = corners(foot.triangle, u);
      const Eigen::Vector3d a = x.col(1) - x.col(0), b = x.col(2) - x.col(0), normal = a.cross(b);
      const Eigen::Vector3d across = foot.offset - foot.normal.dot(foot.offset) * foot.normal;
      Eigen::Matrix3d rows = foot.normal * barycentric(a, b, foot.place - x.col(0)).transpose();
      const Eigen::Vector3d of_a = b.cross(across) / normal.norm(), of_b = across.cross(a) / normal.norm();
      rows.col(0) += of_a + of_b;
      rows.col(1) -= of_a;
      rows.col(2) -= of_b;
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(static_cast<Eigen::Index>(i), 3 * triangles_.nodes(k, foot.triangle) + c, rows(c, k));
      }
    }
    RowTangent out(observation.points.cols(), u.size());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  std::vector<int> nodes(const Observation&) const override {
    return {triangles_.nodes.data(), triangles_.nodes.data() + triangles_.nodes.size()};
  }

 private:
  Eigen::Matrix3d corners(Eigen::Index t, const Eigen::Ref<const Eigen::VectorXd>& u) const {
    Eigen::Matrix3d x;
    for (int i = 0; i < 3; ++i) {
      const int node = triangles_.nodes(i, t);
      x.col(i) = mesh_.nodes.col(node) + u.segment<3>(3 * node);
    }
    return x;
  }

  /// The foot of a point is the closest place on the displaced surface.
  struct Foot {
    Eigen::Index triangle = -1;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of the point from the foot
  };

  // Returns the weights of a triangle's corners at `place`. All vectors start from its first corner.
  static Eigen::Vector3d barycentric(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& place) {
    const Eigen::Vector3d normal = a.cross(b);
    const double second = place.cross(b).dot(normal) / normal.squaredNorm(),
                 third = a.cross(place).dot(normal) / normal.squaredNorm();
    return {1.0 - second - third, second, third};
  }

  std::vector<Foot> find_feet(const Eigen::Matrix3Xd& points, const Eigen::Ref<const Eigen::VectorXd>& u) const {
    auto centroids = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    for (Eigen::Index t = 0; t < triangles_.nodes.cols(); ++t) {
      const Eigen::Vector3f c = (corners(t, u).rowwise().mean()).cast<float>();
      centroids->push_back(pcl::PointXYZ(c.x(), c.y(), c.z()));
    }
    pcl::KdTreeFLANN<pcl::PointXYZ> tree;
    tree.setInputCloud(pcl::PointCloud<pcl::PointXYZ>::ConstPtr(centroids.get(), [centroids](const auto*) {}));
    std::vector<Foot> out;
    for (Eigen::Index i = 0; i < points.cols(); ++i) out.push_back(find_foot(points.col(i), u, tree));
    return out;
  }

  Foot find_foot(const Eigen::Vector3d& point, const Eigen::Ref<const Eigen::VectorXd>& u,
                 const pcl::KdTreeFLANN<pcl::PointXYZ>& tree) const {
    std::vector<int> near(kCandidates);
    std::vector<float> squared(kCandidates);
    const Eigen::Vector3f f = point.cast<float>();
    const int found = tree.nearestKSearch(pcl::PointXYZ(f.x(), f.y(), f.z()), kCandidates, near, squared);
    Foot best;
    double closest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < found; ++k) {
      const Eigen::Index t = near[static_cast<std::size_t>(k)];
      const Eigen::Matrix3d x = corners(t, u);
      const Eigen::Vector3d place = closest_on_triangle(point, x.col(0), x.col(1), x.col(2));
      if ((point - place).norm() >= closest) continue;
      closest = (point - place).norm();
      best = {t, place, (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).normalized(), point - place};
    }
    return best;
  }

  const TetMesh& mesh_;
  double noise_;
  SurfaceTriangles triangles_;
};

}  // namespace

std::unique_ptr<ObservationOperator> make_point_operator(const Model& model, const ObservationSettings& settings) {
  return std::make_unique<PointOperator>(model, settings);
}

}  // namespace tissue_stiffness
