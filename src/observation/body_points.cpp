#include "observation/body_points.hpp"

#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr double kVoxels = 25.0;  // across the body, where no voxel is stated
constexpr double kRadius = 2.5;   // voxels: where others count as neighbours
constexpr double kBand = 3.0;     // standard deviations of the noise: thickness of a plane
constexpr int kMostPlanes = 3;
constexpr std::size_t kMostSamples = 2000;  // points that planes are looked for in
constexpr std::size_t kLeastOnPlane = 100;  // points
constexpr double kLeastShare = 0.2;         // of the points outside that a plane must hold
constexpr double kMostBehind = 0.1;         // of the mesh; a plane with more of it behind cuts through the body
constexpr int kIterations = 200;

Cloud::Ptr to_cloud(const std::vector<Eigen::Vector3d>& points) {
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3f f = p.cast<float>();
    cloud->push_back(pcl::PointXYZ(f.x(), f.y(), f.z()));
  }
  return cloud;
}

using Plane = Eigen::Hyperplane<double, 3>;

/// Returns the planes that hold many of the points, each with the mesh on its positive side.
std::vector<Plane> find_planes(std::vector<Eigen::Vector3d> points, const Eigen::Matrix3Xd& mesh, double band) {
  std::vector<Plane> planes;
  const auto needed = std::max(kLeastOnPlane, static_cast<std::size_t>(kLeastShare * static_cast<double>(points.size())));
  for (int k = 0; k < kMostPlanes && points.size() >= needed; ++k) {
    const pcl::SampleConsensusModelPlane<pcl::PointXYZ>::Ptr model(
        new pcl::SampleConsensusModelPlane<pcl::PointXYZ>(to_cloud(points)));  // always with the same random numbers
    pcl::RandomSampleConsensus<pcl::PointXYZ> search(model, band);
    search.setMaxIterations(kIterations);
    if (!search.computeModel()) break;
    std::vector<int> on;
    Eigen::VectorXf rough, fitted;
    search.getInliers(on);
    search.getModelCoefficients(rough);
    if (on.size() < needed) break;
    model->optimizeModelCoefficients(on, rough, fitted);
    Plane plane;
    plane.coeffs() = fitted.cast<double>();
    plane.normalize();
    if (plane.signedDistance(mesh.rowwise().mean()) < 0.0) plane.coeffs() *= -1.0;
    const auto behind = (((plane.normal().transpose() * mesh).array() + plane.offset()) < -band).count();
    if (static_cast<double>(behind) <= kMostBehind * static_cast<double>(mesh.cols())) planes.push_back(plane);
    const auto near = [&](const Eigen::Vector3d& p) { return plane.absDistance(p) < band; };
    points.erase(std::remove_if(points.begin(), points.end(), near), points.end());
  }
  return planes;
}

}  // namespace

BodyPoints::BodyPoints(const DepthCameraSettings& settings, double noise, const TetMesh& mesh)
    : settings_(settings), noise_(noise), nodes_(mesh.nodes) {
  const Eigen::Vector3d low = nodes_.rowwise().minCoeff(), high = nodes_.rowwise().maxCoeff();
  const double size = (high - low).norm();
  if (settings_.voxel == 0.0) settings_.voxel = size / kVoxels;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(settings_.margin), around = Eigen::Vector3d::Constant(size);
  box_ = Eigen::AlignedBox3d(low - margin, high + margin);
  surroundings_ = Eigen::AlignedBox3d(low - margin - around, high + margin + around);
  const double count = (box_.sizes() / settings_.voxel).array().ceil().prod();
  if (count > std::numeric_limits<int>::max()) {
    throw InputError("depth_camera: voxel",
                     std::to_string(settings_.voxel) + " m, which makes " + std::to_string(count) + " voxels",
                     "a larger edge, or a smaller margin");
  }
}

Eigen::Matrix3Xd BodyPoints::select(const Eigen::Matrix3Xd& points) const {
  std::vector<Eigen::Vector3d> inside, outside;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d p = points.col(i);
    if (!p.allFinite() || !surroundings_.contains(p)) continue;
    (box_.contains(p) ? inside : outside).push_back(p);
  }
  const std::size_t stride = outside.size() / kMostSamples + 1;
  std::vector<Eigen::Vector3d> samples;
  for (std::size_t i = 0; i < outside.size(); i += stride) samples.push_back(outside[i]);
  for (const Plane& plane : find_planes(std::move(samples), nodes_, kBand * noise_)) {
    const auto away = [&](const Eigen::Vector3d& p) { return plane.signedDistance(p) < kBand * noise_; };
    inside.erase(std::remove_if(inside.begin(), inside.end(), away), inside.end());
  }
  if (inside.empty()) return Eigen::Matrix3Xd(3, 0);

  Cloud occupied, cleaned;
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  const auto leaf = static_cast<float>(settings_.voxel);
  grid.setInputCloud(to_cloud(inside));
  grid.setLeafSize(leaf, leaf, leaf);
  grid.filter(occupied);
  std::vector<Eigen::Vector3d> chosen;
  std::mt19937 random(1);
  std::sample(inside.begin(), inside.end(), std::back_inserter(chosen), occupied.size(), random);
  pcl::RadiusOutlierRemoval<pcl::PointXYZ> outliers;
  outliers.setInputCloud(to_cloud(chosen));
  outliers.setRadiusSearch(kRadius * settings_.voxel);
  outliers.setMinNeighborsInRadius(settings_.neighbours);
  outliers.filter(cleaned);
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(cleaned.size()));
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    out.col(i) = cleaned.points[static_cast<std::size_t>(i)].getVector3fMap().cast<double>();
  }
  return out;
}

std::map<int, BodyPoints> make_body_points(const ModelSettings& settings, const TetMesh& mesh) {
  std::map<int, BodyPoints> out;
  for (std::size_t i = 0; i < settings.observations.size(); ++i) {
    const ObservationSettings& observation = settings.observations[i];
    if (!observation.depth_camera) continue;
    out.emplace(static_cast<int>(i), BodyPoints(*observation.depth_camera, observation.noise, mesh));
  }
  return out;
}

void select_body(const std::map<int, BodyPoints>& body_points, const ModelSettings& settings, Observation* observation) {
  const auto found = body_points.find(observation->source);
  if (found == body_points.end()) return;
  const Eigen::Index count = observation->points.cols();
  observation->points = found->second.select(observation->points);
  if (observation->points.cols() > 0) return;
  throw InputError(settings.observations[static_cast<std::size_t>(observation->source)].topic,
                   "a cloud of " + std::to_string(count) + " points with a number, none of which is the body's",
                   "points within `margin` of the mesh, off every plane");
}

}  // namespace tissue_stiffness
