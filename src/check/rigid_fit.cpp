#include "check/rigid_fit.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "observation/closest_point.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostSteps = 60;
constexpr double kStill = 1e-4;  // relative fall of the distance at which the iteration ends
constexpr double kFlat = 1e-6;   // singular value, of the largest, below which points lie on a line

double root_mean_square(const Eigen::Matrix3Xd& difference) {
  return std::sqrt(difference.squaredNorm() / static_cast<double>(difference.cols()));
}

Eigen::Matrix3Xd feet(const Eigen::Matrix3Xd& points, const TetMesh& mesh) {
  Eigen::Matrix3Xd out(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) out.col(i) = closest_surface_point(mesh, points.col(i)).point;
  return out;
}

RigidFit iterate(const Eigen::Matrix3Xd& points, const TetMesh& mesh, RigidFit fit) {
  fit.rms = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    const RigidFit next = fit_pairs(points, feet(fit.motion * points, mesh));
    if (next.rms > (1.0 - kStill) * fit.rms) break;
    fit = next;
  }
  fit.rms = distance_from_surface(fit.motion * points, mesh);
  return fit;
}

}  // namespace

RigidFit fit_pairs(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Vector3d centre = from.rowwise().mean(), target = to.rowwise().mean();
  const Eigen::Matrix3d spread = (to.colwise() - target) * (from.colwise() - centre).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  RigidFit fit;
  if (svd.singularValues()[1] > kFlat * svd.singularValues()[0]) {
    Eigen::Matrix3d handed = Eigen::Matrix3d::Identity();
    handed(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    fit.motion.linear() = svd.matrixU() * handed * svd.matrixV().transpose();
  }
  fit.motion.translation() = target - fit.motion.linear() * centre;
  fit.rms = root_mean_square(fit.motion * from - to);
  return fit;
}

RigidFit fit_surface(const Eigen::Matrix3Xd& points, const TetMesh& mesh) {
  const RigidFit here = iterate(points, mesh, {});
  RigidFit centred;
  centred.motion.translation() = mesh.nodes.rowwise().mean() - points.rowwise().mean();
  const RigidFit there = iterate(points, mesh, centred);
  return there.rms < here.rms ? there : here;
}

double distance_from_surface(const Eigen::Matrix3Xd& points, const TetMesh& mesh) {
  return root_mean_square(points - feet(points, mesh));
}

}  // namespace tissue_stiffness
