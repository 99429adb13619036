#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "meshing/bodies.hpp"
#include "meshing/polygon.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kCornerSigmas = 4.0;   // an outline point farther from a side than this makes a corner
constexpr double kUnseenSigmas = 10.0;  // of the largest seen sigma, for points whose edge was not seen

// Outline in metres about the optical axis, in the middle plane, with its noise.
struct Outline {
  Eigen::Matrix2Xd points;
  Eigen::VectorXd sigma;
};

Outline to_metres(const Contour& contour, const Camera& camera, double depth, double distance) {
  Outline outline{contour.points, contour.sigma};
  const bool slice = camera.projection == Camera::Projection::slice;
  const double seen = contour.sigma.array().isFinite().select(contour.sigma, 0.0).maxCoeff();
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    const Eigen::Vector2d p((contour.points(0, i) - camera.cx) / camera.fx, (contour.points(1, i) - camera.cy) / camera.fy);
    const Eigen::Vector2d n(contour.normals(0, i) * camera.fx, contour.normals(1, i) * camera.fy);
    const double face = n.dot(p) > 0.0 ? distance - 0.5 * depth : distance + 0.5 * depth;
    const double scale = slice ? 1.0 : face;
    const double sigma = std::isfinite(contour.sigma[i]) ? contour.sigma[i] : kUnseenSigmas * seen;
    outline.points.col(i) = scale * p;
    outline.sigma[i] = scale * sigma / std::sqrt(camera.fx * camera.fy);
  }
  return outline;
}

double line_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d side = b - a;
  if (side.norm() == 0.0) return (p - a).norm();
  return std::abs(side.x() * (p - a).y() - side.y() * (p - a).x()) / side.norm();
}

// Finds corners between points `first` and `last` (Ramer 1972, Douglas and Peucker 1973). Indices are modulo the outline's
// size.
void split(const Outline& outline, Eigen::Index first, Eigen::Index last, std::vector<Eigen::Index>& corners) {
  const Eigen::Index n = outline.points.cols();
  double worst = kCornerSigmas;
  Eigen::Index corner = -1;
  for (Eigen::Index i = first + 1; i < last; ++i) {
    const double off =
        line_distance(outline.points.col(first % n), outline.points.col(last % n), outline.points.col(i % n)) /
        outline.sigma[i % n];
    if (off > worst) {
      worst = off;
      corner = i;
    }
  }
  if (corner < 0) return;
  split(outline, first, corner, corners);
  corners.push_back(corner % n);
  split(outline, corner, last, corners);
}

std::vector<Eigen::Index> find_corners(const Outline& outline) {
  Eigen::Index start = 0, opposite = 0;
  const Eigen::Vector2d middle = outline.points.rowwise().mean();
  (outline.points.colwise() - middle).colwise().squaredNorm().maxCoeff(&start);
  (outline.points.colwise() - outline.points.col(start)).colwise().squaredNorm().maxCoeff(&opposite);
  const Eigen::Index n = outline.points.cols();
  if (opposite < start) opposite += n;
  std::vector<Eigen::Index> corners = {start};
  split(outline, start, opposite, corners);
  corners.push_back(opposite % n);
  split(outline, opposite, start + n, corners);
  return corners;
}

// Returns a polygon with knots at the corners and at most `length` apart. It is fitted to all points by weighted least
// squares.
Eigen::Matrix2Xd fit_polygon(const Outline& outline, double length) {
  const Eigen::Index n = outline.points.cols();
  const std::vector<Eigen::Index> corners = find_corners(outline);
  Eigen::VectorXd place(n);  // of each point along the polygon, in knots
  double knots = 0.0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Eigen::Index first = corners[c], next = corners[(c + 1) % corners.size()];
    const Eigen::Index last = next > first ? next : next + n;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(last - first + 1);
    for (Eigen::Index i = 1; i < along.size(); ++i) {
      along[i] = along[i - 1] + (outline.points.col((first + i) % n) - outline.points.col((first + i - 1) % n)).norm();
    }
    const double total = along[along.size() - 1];
    const double most = std::max<double>(1.0, static_cast<double>((last - first) / 2));
    const double parts = std::min(most, std::ceil(total / length));
    for (Eigen::Index i = 0; i + 1 < along.size(); ++i) place[(first + i) % n] = knots + parts * along[i] / total;
    knots += parts;
  }
  const auto count = static_cast<Eigen::Index>(knots);
  Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(n, count);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto left = static_cast<Eigen::Index>(place[i]);
    const double share = place[i] - static_cast<double>(left);
    hats(i, left % count) += 1.0 - share;
    hats(i, (left + 1) % count) += share;
  }
  const Eigen::VectorXd weights = outline.sigma.cwiseInverse();
  const Eigen::MatrixXd fitted = (weights.asDiagonal() * hats)
                                     .colPivHouseholderQr()
                                     .solve(Eigen::MatrixXd(weights.asDiagonal() * outline.points.transpose()));
  return fitted.transpose();
}

}  // namespace

TriangleSurface extruded_surface(const Contour& contour, const Camera& camera, double depth, double edge_length) {
  const Eigen::Vector3d origin_in_sensor = camera.model_from_sensor.inverse().translation();
  const bool slice = camera.projection == Camera::Projection::slice;
  const double distance = slice ? 0.0 : origin_in_sensor.z();
  if (!slice && distance - 0.5 * depth <= 0.0) {
    throw InputError("mesh.extrude.depth", std::to_string(depth) + " m, which reaches behind the camera",
                     "less than twice the " + std::to_string(distance) + " m to the model's origin");
  }
  Eigen::Matrix2Xd polygon = fit_polygon(to_metres(contour, camera, depth, distance), edge_length);
  if (polygon.cols() < 3 || find_crossing(polygon)) {
    throw InputError("contour for the mesh", "an outline whose fitted polygon crosses itself",
                     "an outline wider than its noise, or a smaller mesh.extrude.max_edge_length");
  }
  if (polygon_area(polygon) < 0.0) polygon = polygon.rowwise().reverse().eval();
  const auto n = static_cast<int>(polygon.cols());
  TriangleSurface surface{Eigen::Matrix3Xd(3, 2 * n), Eigen::Matrix3Xi(3, 4 * n - 4)};
  for (int i = 0; i < n; ++i) {
    for (int face = 0; face < 2; ++face) {
      const double z = distance + (face == 0 ? -0.5 : 0.5) * depth;
      surface.vertices.col(i + face * n) = camera.model_from_sensor * Eigen::Vector3d(polygon(0, i), polygon(1, i), z);
    }
    const int next = (i + 1) % n;
    surface.triangles.col(2 * i) << i, next, next + n;
    surface.triangles.col(2 * i + 1) << i, next + n, i + n;
  }
  int t = 2 * n;
  std::vector<int> outline(static_cast<std::size_t>(n));
  std::iota(outline.begin(), outline.end(), 0);
  for (const Eigen::Vector3i& ear : cut_ears(polygon, {outline})) {
    surface.triangles.col(t++) << ear[0], ear[2], ear[1];
    surface.triangles.col(t++) = ear.array() + n;
  }
  return surface;
}

}  // namespace tissue_stiffness
