#include "effects/spread_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr int kPasses = 30;

// Returns centroids (rows 0-2) and volumes (row 3) of the tetrahedra.
Eigen::Matrix4Xd cells(const TetMesh& mesh) {
  Eigen::Matrix4Xd list(4, mesh.tet_count());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Eigen::Matrix<double, 3, 4> x;
    for (int k = 0; k < 4; ++k) x.col(k) = mesh.nodes.col(mesh.tets(k, t));
    list.col(t) << x.rowwise().mean(), (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) / 6.0;
  }
  return list;
}

Eigen::Matrix3Xd farthest_points(const Eigen::Matrix4Xd& cells, Eigen::Index count) {
  Eigen::Matrix3Xd points(3, count);
  points.col(0) = cells.topRows<3>() * cells.row(3).transpose() / cells.row(3).sum();
  Eigen::RowVectorXd nearest = (cells.topRows<3>().colwise() - points.col(0)).colwise().squaredNorm();
  for (Eigen::Index i = 1; i < count; ++i) {
    Eigen::Index at = 0;
    nearest.maxCoeff(&at);
    points.col(i) = cells.col(at).head<3>();
    nearest = nearest.cwiseMin((cells.topRows<3>().colwise() - points.col(i)).colwise().squaredNorm());
  }
  return points;
}

}  // namespace

SpreadPoints spread_points(const TetMesh& mesh, int count) {
  const Eigen::Matrix4Xd all = cells(mesh);
  const Eigen::Index k = std::min<Eigen::Index>(count, all.cols());
  SpreadPoints result{farthest_points(all, k), std::cbrt(all.row(3).sum() / static_cast<double>(k))};
  for (int pass = 0; pass < kPasses; ++pass) {
    Eigen::Matrix4Xd sums = Eigen::Matrix4Xd::Zero(4, k);
    for (Eigen::Index t = 0; t < all.cols(); ++t) {
      Eigen::Index nearest = 0;
      (result.points.colwise() - all.col(t).head<3>()).colwise().squaredNorm().minCoeff(&nearest);
      sums.col(nearest).head<3>() += all(3, t) * all.col(t).head<3>();
      sums(3, nearest) += all(3, t);
    }
    for (Eigen::Index i = 0; i < k; ++i) {
      if (sums(3, i) > 0.0) result.points.col(i) = sums.col(i).head<3>() / sums(3, i);
    }
  }
  return result;
}

}  // namespace tissue_stiffness
