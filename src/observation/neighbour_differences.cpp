#include "observation/neighbour_differences.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kNeighbours = 8;  // that the affine fit takes
constexpr std::size_t kFewest = 5;      // one more than an affine function has coefficients
constexpr Eigen::Index kPoints = 128;   // at which differences are taken, evenly spread over the rows

struct Point {
  Eigen::Index first, components;
  bool used;
};

std::vector<Point> points_of(const Eigen::Matrix3Xd& places, const Eigen::VectorXd& used) {
  std::vector<Point> out;
  for (Eigen::Index r = 0; r < places.cols(); ++r) {
    const bool told = used[r] > 0.0 && places.col(r).allFinite();
    if (!out.empty() && places.col(out.back().first) == places.col(r)) {
      ++out.back().components;
      out.back().used = out.back().used && told;
    } else {
      out.push_back({r, 1, told});
    }
  }
  return out;
}

// Returns the nearest points that have as many components, nearest first.
std::vector<Point> neighbours_of(const Point& point, const std::vector<Point>& all, const Eigen::Matrix3Xd& places) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].used || all[k].components != point.components || all[k].first == point.first) continue;
    near.emplace_back((places.col(all[k].first) - places.col(point.first)).squaredNorm(), k);
  }
  const std::size_t count = std::min(kNeighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  std::vector<Point> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(all[near[k].second]);
  return out;
}

// Returns the weights with which the neighbours' values give that of the affine function at the point.
Eigen::VectorXd weights_of(const Point& point, const std::vector<Point>& neighbours, const Eigen::Matrix3Xd& places) {
  const auto count = static_cast<Eigen::Index>(neighbours.size());
  Eigen::MatrixXd affine = Eigen::MatrixXd::Ones(4, count);
  for (Eigen::Index j = 0; j < count; ++j)
    affine.col(j).tail<3>() = places.col(neighbours[static_cast<std::size_t>(j)].first) - places.col(point.first);
  affine.bottomRows<3>() /= affine.bottomRows<3>().colwise().norm().maxCoeff();
  // The minimum norm among all weights that reproduce affine functions.
  return affine.completeOrthogonalDecomposition().solve(Eigen::Vector4d::UnitX());
}

}  // namespace

SparseMatrix neighbour_weights(const Eigen::Matrix3Xd& places, const Eigen::VectorXd& used) {
  const std::vector<Point> all = points_of(places, used);
  const auto count = static_cast<Eigen::Index>(all.size());
  const Eigen::Index taken = count > static_cast<Eigen::Index>(kFewest) ? std::min(count, kPoints) : 0;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index row = 0;
  for (Eigen::Index k = 0; k < taken; ++k) {
    const Point& point = all[static_cast<std::size_t>(k * count / taken)];
    const Eigen::Index first = std::exchange(row, row + point.components);
    if (!point.used) continue;
    const std::vector<Point> neighbours = neighbours_of(point, all, places);
    if (neighbours.size() < kFewest) continue;
    const Eigen::VectorXd weights = weights_of(point, neighbours, places);
    for (Eigen::Index c = 0; c < point.components; ++c) {
      entries.emplace_back(first + c, point.first + c, -1.0);
      for (std::size_t j = 0; j < neighbours.size(); ++j)
        entries.emplace_back(first + c, neighbours[j].first + c, weights[static_cast<Eigen::Index>(j)]);
    }
  }
  SparseMatrix out(row, places.cols());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

SparseMatrix neighbour_differences(const SparseMatrix& weights, const Eigen::VectorXd& sigma) {
  SparseMatrix out = weights;
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(out.rows());
  const auto each = [&out](const auto& change) {
    for (Eigen::Index c = 0; c < out.outerSize(); ++c) {
      for (SparseMatrix::InnerIterator entry(out, c); entry; ++entry) change(entry);
    }
  };
  each([&](auto& entry) {
    entry.valueRef() *= sigma[entry.col()];
    variance[entry.row()] += entry.value() * entry.value();
  });
  each([&](auto& entry) { entry.valueRef() /= std::sqrt(variance[entry.row()]); });
  return out;
}

SparseMatrix neighbour_differences(const Eigen::Matrix3Xd& places, const Eigen::VectorXd& sigma,
                                   const Eigen::VectorXd& used) {
  return neighbour_differences(neighbour_weights(places, used), sigma);
}

const SparseMatrix& NeighbourWeights::of(const Eigen::VectorXi& nodes, const Eigen::Matrix3Xd& places,
                                         const Eigen::VectorXd& used) {
  const Eigen::Array<bool, Eigen::Dynamic, 1> now = used.array() > 0.0;
  if (nodes.size() != nodes_.size() || nodes != nodes_ || (now != used_).any()) {
    nodes_ = nodes;
    used_ = now;
    weights_ = neighbour_weights(places, used);
  }
  return weights_;
}

}  // namespace tissue_stiffness
