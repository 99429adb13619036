#include "meshing/viewing_rays.hpp"

#include <cmath>
#include <sstream>

#include "meshing/polygon.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastSigma = 1e-3;  // [pixel]; no outline is known better, and weights stay finite

std::string pixel(const Eigen::Vector2d& p) {
  std::ostringstream out;
  out << "pixel (" << p.x() << ", " << p.y() << ")";
  return out.str();
}

}  // namespace

void check_outline(const Contour& contour) {
  const std::string where = "contour for the mesh";
  if (!contour.closed) throw InputError(where, "an open outline", "an outline whose last point joins the first");
  if (contour.normals.cols() != contour.size() || contour.sigma.size() != contour.size()) {
    throw InputError(where, "another count of normals or sigmas than points", "one a point");
  }
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    if (contour.points.col(i).allFinite() && contour.sigma[i] > 0.0) continue;
    throw InputError(where, "point " + std::to_string(i) + " without a finite place or a positive sigma",
                     "finite places and positive sigmas");
  }
  const Eigen::Index seen = contour.sigma.array().isFinite().count();
  if (seen < kMinOutlinePoints) {
    throw InputError(where, std::to_string(seen) + " points whose edge was seen",
                     std::to_string(kMinOutlinePoints) + " or more");
  }
  if (const auto crossing = find_crossing(contour.points)) {
    throw InputError(where, "an outline that crosses itself at " + pixel(contour.points.col(crossing->first)),
                     "an outline without crossings");
  }
}

ViewingRays viewing_rays(const Contour& contour, const Camera& camera) {
  ViewingRays rays;
  const Eigen::Index seen = contour.sigma.array().isFinite().count();
  rays.origins.resize(3, seen);
  rays.directions.resize(3, seen);
  rays.sigma.resize(seen);
  const bool slice = camera.projection == Camera::Projection::slice;
  const double focal = std::sqrt(camera.fx * camera.fy);
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    if (!std::isfinite(contour.sigma[i])) continue;
    const Eigen::Vector2d p((contour.points(0, i) - camera.cx) / camera.fx, (contour.points(1, i) - camera.cy) / camera.fy);
    const Eigen::Vector3d origin = slice ? Eigen::Vector3d(p.x(), p.y(), 0.0) : Eigen::Vector3d::Zero().eval();
    const Eigen::Vector3d direction = slice ? Eigen::Vector3d::UnitZ().eval() : Eigen::Vector3d(p.x(), p.y(), 1.0);
    rays.origins.col(row) = camera.model_from_sensor * origin;
    rays.directions.col(row) = (camera.model_from_sensor.linear() * direction).normalized();
    rays.sigma[row] = std::max(contour.sigma[i], kLeastSigma) / focal;
    ++row;
  }
  return rays;
}

}  // namespace tissue_stiffness
