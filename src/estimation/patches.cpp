#include "estimation/patches.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kAlmost = 0.8;  // of the largest spread, squared: an axis with that much is preferred

Eigen::Vector3d centroid(const TetMesh& mesh, int tet) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < 4; ++corner) sum += mesh.nodes.col(mesh.tets(corner, tet));
  return sum / 4.0;
}

double volume(const TetMesh& mesh, const Patch& patch) {
  return std::accumulate(patch.begin(), patch.end(), 0.0, [&](double sum, int tet) { return sum + tet_volume(mesh, tet); });
}

double splittable(const TetMesh& mesh, const Patch& patch) {
  return patch.size() > 1 ? volume(mesh, patch) : 0.0;
}

Eigen::Vector3d center(const TetMesh& mesh, const Patch& patch) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int tet : patch) sum += tet_volume(mesh, tet) * centroid(mesh, tet);
  return sum / volume(mesh, patch);
}

Eigen::Vector3d longest_direction(const TetMesh& mesh, const Patch& patch) {
  const Eigen::Vector3d middle = center(mesh, patch);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const int tet : patch) {
    const Eigen::Vector3d arm = centroid(mesh, tet) - middle;
    spread += tet_volume(mesh, tet) * arm * arm.transpose();
  }
  Eigen::Index axis = 0;
  const double along_axis = spread.diagonal().maxCoeff(&axis);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  if (along_axis >= kAlmost * eigen.eigenvalues()[2]) return Eigen::Vector3d::Unit(axis);
  return eigen.eigenvectors().col(2);
}

// Returns two parts of equal volume, as far as whole tetrahedra allow; each holds at least one.
std::pair<Patch, Patch> halves(const TetMesh& mesh, const Patch& patch) {
  const Eigen::Vector3d along = longest_direction(mesh, patch);
  std::vector<std::pair<double, int>> order;
  for (const int tet : patch) order.emplace_back(along.dot(centroid(mesh, tet)), tet);
  std::sort(order.begin(), order.end());
  const double half = 0.5 * volume(mesh, patch);
  std::pair<Patch, Patch> out;
  double sum = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double own = tet_volume(mesh, order[i].second);
    const bool first = i == 0 || (sum + 0.5 * own < half && i + 1 < order.size());
    sum += own;
    (first ? out.first : out.second).push_back(order[i].second);
  }
  std::sort(out.first.begin(), out.first.end());
  std::sort(out.second.begin(), out.second.end());
  return out;
}

}  // namespace

Division divide_patches(const TetMesh& mesh, const std::vector<Patch>& patches, int count) {
  Division out{patches, std::vector<int>(patches.size())};
  std::iota(out.parent.begin(), out.parent.end(), 0);
  std::vector<double> size;
  for (const Patch& patch : patches) size.push_back(splittable(mesh, patch));
  while (static_cast<int>(out.patches.size()) < count) {
    const auto largest = std::max_element(size.begin(), size.end());
    if (!(*largest > 0.0)) break;
    const auto at = static_cast<std::size_t>(largest - size.begin());
    auto [first, second] = halves(mesh, out.patches[at]);
    size[at] = splittable(mesh, first);
    size.push_back(splittable(mesh, second));
    out.patches[at] = std::move(first);
    out.patches.push_back(std::move(second));
    out.parent.push_back(out.parent[at]);
  }
  return out;
}

Eigen::Matrix3Xd centers(const TetMesh& mesh, const std::vector<Patch>& patches) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(patches.size()));
  for (std::size_t i = 0; i < patches.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = center(mesh, patches[i]);
  return out;
}

Eigen::MatrixXd smooth_covariance(const Eigen::Matrix3Xd& places, double length, double std) {
  const Eigen::Index n = places.cols();
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double r = std::sqrt(3.0) * (places.col(i) - places.col(j)).norm() / length;
      out(i, j) = std * std * (1.0 + r) * std::exp(-r);
    }
  }
  return out;
}

}  // namespace tissue_stiffness
