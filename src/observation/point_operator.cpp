// Surface points have no identity. Each row is the distance along the normal of the closest place on the displaced surface.
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <limits>

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
    const Eigen::Index count = triangles_.nodes.cols();
    auto centroids = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    for (Eigen::Index t = 0; t < count; ++t) {
      const Eigen::Vector3f c = (corners(t, u).rowwise().mean()).cast<float>();
      centroids->push_back(pcl::PointXYZ(c.x(), c.y(), c.z()));
    }
    pcl::KdTreeFLANN<pcl::PointXYZ> tree;
    tree.setInputCloud(pcl::PointCloud<pcl::PointXYZ>::ConstPtr(centroids.get(), [centroids](const auto*) {}));
    const Eigen::Index n = observation.points.cols();
    Prediction p;
    p.measured = Eigen::VectorXd::Zero(n);
    p.predicted.resize(n);
    p.sigma = Eigen::VectorXd::Constant(n, noise_);
    p.places = observation.points;
    p.nodes.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) compare(observation.points.col(i), u, tree, i, p);
    return p;
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

  void compare(const Eigen::Vector3d& point, const Eigen::Ref<const Eigen::VectorXd>& u,
               const pcl::KdTreeFLANN<pcl::PointXYZ>& tree, Eigen::Index row, Prediction& p) const {
    std::vector<int> near(kCandidates);
    std::vector<float> squared(kCandidates);
    const Eigen::Vector3f f = point.cast<float>();
    const int found = tree.nearestKSearch(pcl::PointXYZ(f.x(), f.y(), f.z()), kCandidates, near, squared);
    double best = std::numeric_limits<double>::infinity();
    p.predicted[row] = std::numeric_limits<double>::quiet_NaN();
    p.nodes[row] = 0;
    for (int k = 0; k < found; ++k) {
      const Eigen::Index t = near[static_cast<std::size_t>(k)];
      const Eigen::Matrix3d x = corners(t, u);
      const Eigen::Vector3d foot = closest_on_triangle(point, x.col(0), x.col(1), x.col(2));
      const double distance = (point - foot).norm();
      if (distance >= best) continue;
      best = distance;
      const Eigen::Vector3d normal = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).normalized();
      p.predicted[row] = -normal.dot(point - foot);
      p.nodes[row] = triangles_.nodes(0, t);
    }
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
