#include "meshing/signed_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "meshing/closest_on_triangle.hpp"

namespace tissue_stiffness {
namespace {

namespace bg = boost::geometry;
using BoostPoint = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<BoostPoint>;
using Entry = std::pair<Box, int>;

constexpr double kOnSurface = 1e-9;  // of the surface's size: closer points have no direction of their own

BoostPoint to_boost(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct SignedDistance::Tree {
  bg::index::rtree<Entry, bg::index::rstar<16>> boxes;
};

SignedDistance::SignedDistance(TriangleSurface surface)
    : surface_(std::move(surface)),
      neighbours_(triangle_neighbours(surface_)),
      low_(surface_.vertices.rowwise().minCoeff()),
      high_(surface_.vertices.rowwise().maxCoeff()) {
  sum_normals();
  std::vector<Entry> entries;
  for (int t = 0; t < surface_.triangle_count(); ++t) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = corner(t, i);
    entries.emplace_back(Box(to_boost(corners.rowwise().minCoeff()), to_boost(corners.rowwise().maxCoeff())), t);
  }
  auto tree = std::make_unique<Tree>();
  tree->boxes = decltype(tree->boxes)(entries.begin(), entries.end());
  tree_ = std::move(tree);
}

SignedDistance::~SignedDistance() = default;

void SignedDistance::sum_normals() {
  face_normals_.resize(3, surface_.triangle_count());
  vertex_normals_ = Eigen::Matrix3Xd::Zero(3, surface_.vertex_count());
  for (int t = 0; t < surface_.triangle_count(); ++t) {
    const Eigen::Vector3d normal = triangle_area_vector(surface_, t).normalized();
    face_normals_.col(t) = normal;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d at = corner(t, i), one = (corner(t, (i + 1) % 3) - at).normalized(),
                            other = (corner(t, (i + 2) % 3) - at).normalized();
      vertex_normals_.col(surface_.triangles(i, t)) += std::acos(std::clamp(one.dot(other), -1.0, 1.0)) * normal;
    }
  }
}

SignedDistance::Value SignedDistance::operator()(const Eigen::Vector3d& point, double far) const {
  const Eigen::Vector3d off = point - point.cwiseMax(low_).cwiseMin(high_);
  if (off.squaredNorm() > far * far) return {off.norm(), off.normalized(), Eigen::Matrix3d::Zero()};
  // The triangle in the nearest box bounds the distance, so the closest one has a box within it.
  const auto weights_of = [&](int t) { return closest_weights(point, corner(t, 0), corner(t, 1), corner(t, 2)); };
  const auto square_of = [&](int t, const Eigen::Vector3d& weights) {
    Eigen::Vector3d closest = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) closest += weights[i] * corner(t, i);
    return (point - closest).squaredNorm();
  };
  const auto nearest = tree_->boxes.qbegin(bg::index::nearest(to_boost(point), 1));
  int best = nearest->second;
  Eigen::Vector3d weights = weights_of(best);
  double square = square_of(best, weights);
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(std::sqrt(square));
  const Box around(to_boost(point - reach), to_boost(point + reach));
  for (auto entry = tree_->boxes.qbegin(bg::index::intersects(around)); entry != tree_->boxes.qend(); ++entry) {
    const Eigen::Vector3d own = weights_of(entry->second);
    const double own_square = square_of(entry->second, own);
    if (own_square >= square) continue;
    best = entry->second;
    weights = own;
    square = own_square;
  }
  return from_triangle(point, best, weights);
}

SignedDistance::Value SignedDistance::from_triangle(const Eigen::Vector3d& point, int triangle,
                                                    const Eigen::Vector3d& weights) const {
  Eigen::Vector3d closest = Eigen::Vector3d::Zero(), normal = face_normals_.col(triangle), along = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) closest += weights[i] * corner(triangle, i);
  const auto corners = (weights.array() > 0.0).count();
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    if (corners == 1 && weights[i] > 0.0) normal = vertex_normals_.col(surface_.triangles(i, triangle));
    if (corners == 2 && weights[last] == 0.0) {  // the edge from i to next
      normal += face_normals_.col(neighbours_(i, triangle));
      along = (corner(triangle, next) - corner(triangle, i)).normalized();
    }
  }
  const Eigen::Vector3d off = point - closest;
  const double length = off.norm(), sign = off.dot(normal) < 0.0 ? -1.0 : 1.0;
  Value out{sign * length, normal.normalized(), Eigen::Matrix3d::Zero()};
  if (length <= kOnSurface * (high_ - low_).norm()) return out;
  if (corners == 3) return out;
  out.gradient = sign / length * off;
  out.curvature =
      (Eigen::Matrix3d::Identity() - out.gradient * out.gradient.transpose() - along * along.transpose()) / out.distance;
  return out;
}

}  // namespace tissue_stiffness
