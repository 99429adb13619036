#include "meshing/signed_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "meshing/closest_on_triangle.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kLeaf = 4;             // triangles in a box that is not divided further
constexpr double kOnSurface = 1e-9;  // of the surface's size: closer points have no direction of their own

}  // namespace

/// Boxes around triangles, each of which holds two others or the triangles of a leaf.
struct SignedDistance::Tree {
  struct Node {
    Eigen::Vector3d low, high;
    int first, count, right;  ///< triangles in `order`, if this is a leaf; else its left child follows it
  };
  std::vector<Node> nodes;
  std::vector<int> order;

  Tree(const Eigen::Matrix3Xd& low, const Eigen::Matrix3Xd& high) : order(static_cast<std::size_t>(low.cols())) {
    std::iota(order.begin(), order.end(), 0);
    divide(low, high, 0, static_cast<int>(order.size()));
  }

  int divide(const Eigen::Matrix3Xd& low, const Eigen::Matrix3Xd& high, int first, int count) {
    const std::size_t index = nodes.size();
    nodes.push_back({low.col(order[static_cast<std::size_t>(first)]), high.col(order[static_cast<std::size_t>(first)]),
                     first, count <= kLeaf ? count : 0, 0});
    for (int i = first; i < first + count; ++i) {
      const int t = order[static_cast<std::size_t>(i)];
      nodes[index].low = nodes[index].low.cwiseMin(low.col(t));
      nodes[index].high = nodes[index].high.cwiseMax(high.col(t));
    }
    if (count <= kLeaf) return static_cast<int>(index);
    Eigen::Index axis = 0;
    (nodes[index].high - nodes[index].low).maxCoeff(&axis);
    const auto begin = order.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](int a, int b) { return low(axis, a) + high(axis, a) < low(axis, b) + high(axis, b); });
    divide(low, high, first, count / 2);
    const int right = divide(low, high, first + count / 2, count - count / 2);
    nodes[index].right = right;
    return static_cast<int>(index);
  }

  double square_to(int node, const Eigen::Vector3d& p) const {
    const Node& box = nodes[static_cast<std::size_t>(node)];
    return (p - p.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm();
  }

  /// Visits the triangles whose boxes are closer than the root of `square`, which `visit` may lower.
  template <typename Visit>
  void search(int node, const Eigen::Vector3d& p, const double& square, const Visit& visit) const {
    const Node& box = nodes[static_cast<std::size_t>(node)];
    for (int i = box.first; i < box.first + box.count; ++i) visit(order[static_cast<std::size_t>(i)]);
    if (box.count > 0) return;
    int near = node + 1, far = box.right;
    double to_near = square_to(near, p), to_far = square_to(far, p);
    if (to_far < to_near) {
      std::swap(near, far);
      std::swap(to_near, to_far);
    }
    if (to_near < square) search(near, p, square, visit);
    if (to_far < square) search(far, p, square, visit);
  }
};

SignedDistance::SignedDistance(TriangleSurface surface)
    : surface_(std::move(surface)),
      neighbours_(triangle_neighbours(surface_)),
      low_(surface_.vertices.rowwise().minCoeff()),
      high_(surface_.vertices.rowwise().maxCoeff()) {
  sum_normals();
  Eigen::Matrix3Xd low(3, surface_.triangle_count()), high(3, surface_.triangle_count());
  for (int t = 0; t < surface_.triangle_count(); ++t) {
    low.col(t) = corner(t, 0).cwiseMin(corner(t, 1)).cwiseMin(corner(t, 2));
    high.col(t) = corner(t, 0).cwiseMax(corner(t, 1)).cwiseMax(corner(t, 2));
  }
  tree_ = std::make_unique<const Tree>(low, high);
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
  int best = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  double square = std::numeric_limits<double>::infinity();
  const auto consider = [&](int t) {
    const Eigen::Vector3d own = closest_weights(point, corner(t, 0), corner(t, 1), corner(t, 2));
    const double own_square = (point - place(t, own)).squaredNorm();
    if (own_square >= square) return;
    best = t;
    weights = own;
    square = own_square;
  };
  tree_->search(0, point, square, consider);
  return from_triangle(point, best, weights);
}

SignedDistance::Value SignedDistance::from_triangle(const Eigen::Vector3d& point, int triangle,
                                                    const Eigen::Vector3d& weights) const {
  Eigen::Vector3d normal = face_normals_.col(triangle), along = Eigen::Vector3d::Zero();
  const auto corners = (weights.array() > 0.0).count();
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    if (corners == 1 && weights[i] > 0.0) normal = vertex_normals_.col(surface_.triangles(i, triangle));
    if (corners == 2 && weights[last] == 0.0) {  // the edge from i to next
      normal += face_normals_.col(neighbours_(i, triangle));
      along = (corner(triangle, next) - corner(triangle, i)).normalized();
    }
  }
  const Eigen::Vector3d off = point - place(triangle, weights);
  const double length = off.norm(), sign = off.dot(normal) < 0.0 ? -1.0 : 1.0;
  Value out{sign * length, normal.normalized(), Eigen::Matrix3d::Zero()};
  if (corners == 3 || length <= kOnSurface * (high_ - low_).norm()) return out;
  out.gradient = sign / length * off;
  out.curvature =
      (Eigen::Matrix3d::Identity() - out.gradient * out.gradient.transpose() - along * along.transpose()) / out.distance;
  return out;
}

}  // namespace tissue_stiffness
