#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/file_cursor.hpp"
#include "meshing/revolution_profile.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kMostTerms = 25;
constexpr int kIterations = 12;
constexpr int kSamples = 65;
constexpr double kLeastSine = 0.3, kLeastSliceSine = 0.99;  // between the axis and the view

// Axis at the depth of the model's origin, and the direction in which the fit may shift it.
struct Placement {
  Eigen::Vector3d point, axis, sideways;
};

Placement place_axis(const Camera& camera, const Eigen::Vector3d& axis) {
  if (!(axis.norm() > 0.0)) throw InputError("mesh.revolve.axis", format_point(axis), "a direction");
  const Eigen::Vector3d eye = camera.model_from_sensor.translation();
  const bool slice = camera.projection == Camera::Projection::slice;
  const Eigen::Vector3d forward = camera.model_from_sensor.linear().col(2);
  const Eigen::Vector3d view = slice ? forward : Eigen::Vector3d((-eye).normalized());
  const Eigen::Vector3d sideways = axis.normalized().cross(view);
  if (!slice && forward.dot(-eye) <= 0.0) {
    throw InputError("pose of the camera", "the model's origin behind it", "an origin in front of the camera");
  }
  if (sideways.norm() < (slice ? kLeastSliceSine : kLeastSine)) {
    throw InputError("mesh.revolve.axis", format_point(axis) + ", which points at the camera",
                     "an axis seen from the side");
  }
  const Eigen::Vector3d point = slice ? Eigen::Vector3d(forward * forward.dot(eye)) : Eigen::Vector3d::Zero();
  return {point, axis.normalized(), sideways.normalized()};
}

// Returns the signed distance and the height where each line of sight is closest to the axis. This is exact for a cylinder,
// and the fit starts from it.
Eigen::Matrix2Xd closest_approach(const ViewingRays& rays, const Placement& place) {
  Eigen::Matrix2Xd result(2, rays.size());
  for (Eigen::Index i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d d = rays.directions.col(i), w = rays.origins.col(i) - place.point;
    const Eigen::Vector3d n = d.cross(place.axis);
    const double along = d.dot(place.axis);
    const double distance = w.dot(n) / n.norm() * (n.dot(place.sideways) > 0.0 ? 1.0 : -1.0);
    const double t = -(d - along * place.axis).dot(w) / n.squaredNorm();
    result.col(i) << distance, (w + t * d).dot(place.axis);
  }
  return result;
}

Eigen::RowVectorXd cosines(double angle, Eigen::Index terms) {
  return (Eigen::RowVectorXd::LinSpaced(terms, 0.0, static_cast<double>(terms - 1)) * angle).array().cos();
}

// Returns the first guess: it has the radii of the closest approaches about the outline's middle.
RevolutionProfile start_profile(const ViewingRays& rays, const Placement& place) {
  const Eigen::Matrix2Xd approach = closest_approach(rays, place);
  const Eigen::Vector2d middle = 0.5 * (approach.rowwise().minCoeff() + approach.rowwise().maxCoeff());
  const Eigen::Index terms = std::min<Eigen::Index>(7, rays.size() / 4);
  Eigen::MatrixXd basis(rays.size(), terms);
  Eigen::VectorXd radii(rays.size());
  for (Eigen::Index i = 0; i < rays.size(); ++i) {
    const Eigen::Vector2d x = approach.col(i) - middle;
    basis.row(i) = cosines(std::atan2(std::abs(x.x()), x.y()), terms);
    radii[i] = x.norm();
  }
  const Eigen::VectorXd coefficients = basis.colPivHouseholderQr().solve(radii);
  return {place.point + middle.x() * place.sideways + middle.y() * place.axis, place.axis, coefficients};
}

// Returns the point of a line of sight that is deepest in the body, or nearest to it.
Eigen::Vector3d touching_point(const RevolutionProfile& profile, const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) {
  const auto value = [&](double t) {
    const Eigen::Vector3d x = origin + t * direction;
    return (x - profile.centre()).norm() - profile.radius(profile.angle(x));
  };
  const double middle = direction.dot(profile.centre() - origin);
  const double reach = profile.coefficients().cwiseAbs().sum();
  double best = middle, step = 2.0 * reach / (kSamples - 1);
  for (int i = 0; i < kSamples; ++i) {
    const double t = middle - reach + i * step;
    if (value(t) < value(best)) best = t;
  }
  for (int i = 0; i < 40 && step > 1e-9 * reach; ++i) {  // parabola through three points, kept inside their span
    const double left = value(best - step), here = value(best), right = value(best + step);
    const double curvature = left - 2.0 * here + right;
    if (curvature > 0.0) best += std::clamp(0.5 * step * (left - right) / curvature, -step, step);
    step *= 0.5;
  }
  return origin + best * direction;
}

// Rows of the linearised fit: residual/sigma, and its derivatives with respect to R's coefficients and the sideways shift.
struct System {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual, distance;
};

System linearise(const ViewingRays& rays, const RevolutionProfile& profile, const Eigen::Vector3d& sideways, bool slice) {
  const Eigen::Index terms = profile.coefficients().size();
  System system{Eigen::MatrixXd(rays.size(), terms + 1), Eigen::VectorXd(rays.size()), Eigen::VectorXd(rays.size())};
  for (Eigen::Index i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d x = touching_point(profile, rays.origins.col(i), rays.directions.col(i));
    const Eigen::Vector3d outward = (x - profile.centre()).normalized();
    const double tilt = outward.dot(profile.normal(x));  // 1 / |grad(|x| - R)|
    const double sigma = rays.sigma[i] * (slice ? 1.0 : (x - rays.origins.col(i)).norm());
    system.distance[i] = profile.distance(x);
    system.residual[i] = system.distance[i] / sigma;
    system.jacobian.row(i).head(terms) = -tilt / sigma * cosines(profile.angle(x), terms);
    system.jacobian(i, terms) = -profile.normal(x).dot(sideways) / sigma;
  }
  return system;
}

// Returns the weights of c_n^2 in the integral of (R'' + R - c_0)^2 over the angle: pi/2 (n^2-1)^2. They leave spheres free
// wherever their centre is. The last entry is the sideways shift, which is free, too.
Eigen::VectorXd roughness(Eigen::Index terms) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(terms + 1);
  for (Eigen::Index n = 2; n < terms; ++n) weights[n] = 0.5 * M_PI * std::pow(static_cast<double>(n * n - 1), 2);
  return weights;
}

// Chooses the smoothing by generalised cross-validation on the linearised fit: n RSS / (n - trace of the hat matrix)^2.
double choose_smoothing(const System& system, const Eigen::VectorXd& coefficients, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd normal = system.jacobian.transpose() * system.jacobian;
  Eigen::VectorXd target = system.jacobian.leftCols(coefficients.size()) * coefficients - system.residual;
  const Eigen::VectorXd right = system.jacobian.transpose() * target;
  const auto rows = static_cast<double>(target.size());
  const double scale = normal.topLeftCorner(2, 2).trace();
  double best = scale, best_score = std::numeric_limits<double>::infinity();
  for (double exponent = -9.0; exponent <= 2.0; exponent += 0.25) {
    const double smoothing = scale * std::pow(10.0, exponent);
    const Eigen::LDLT<Eigen::MatrixXd> factor(normal + Eigen::MatrixXd((smoothing * weights).asDiagonal()));
    const double freedom = rows - factor.solve(normal).trace();
    const double score = rows * (target - system.jacobian * factor.solve(right)).squaredNorm() / (freedom * freedom);
    if (score <= best_score) {
      best_score = score;
      best = smoothing;
    }
  }
  return best;
}

void require_visible(const RevolutionProfile& profile, double rms, const Eigen::Matrix2Xd& approach) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 180; ++i) least = std::min(least, profile.radius(M_PI * i / 180.0));
  const double size = (approach.rowwise().maxCoeff() - approach.rowwise().minCoeff()).maxCoeff();
  if (least > 0.02 * size && rms < 0.02 * size) return;
  throw InputError("contour for the mesh", "an outline that no body of revolution about mesh.revolve.axis has",
                   "an outline nearly symmetric about the axis, of which the centre sees every point");
}

}  // namespace

ProfileFit fit_profile(const ViewingRays& rays, const Camera& camera, const Eigen::Vector3d& axis) {
  const Placement place = place_axis(camera, axis);
  const bool slice = camera.projection == Camera::Projection::slice;
  const RevolutionProfile start = start_profile(rays, place);
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(std::min<Eigen::Index>(kMostTerms, rays.size() / 3));
  coefficients.head(start.coefficients().size()) = start.coefficients();
  const Eigen::VectorXd weights = roughness(coefficients.size());
  ProfileFit fit{{start.centre(), place.axis, coefficients}, 0.0, 0.0};
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const System system = linearise(rays, fit.profile, place.sideways, slice);
    fit.smoothing = choose_smoothing(system, coefficients, weights);
    const Eigen::MatrixXd normal =
        system.jacobian.transpose() * system.jacobian + Eigen::MatrixXd((fit.smoothing * weights).asDiagonal());
    Eigen::VectorXd right = -system.jacobian.transpose() * system.residual;
    right.head(coefficients.size()) -= fit.smoothing * weights.head(coefficients.size()).cwiseProduct(coefficients);
    const Eigen::VectorXd step = normal.ldlt().solve(right);
    coefficients += step.head(coefficients.size());
    fit.profile = {fit.profile.centre() + step[coefficients.size()] * place.sideways, place.axis, coefficients};
    if (step.norm() < 1e-10 * coefficients[0]) break;
  }
  const System system = linearise(rays, fit.profile, place.sideways, slice);
  fit.rms = std::sqrt(system.distance.squaredNorm() / static_cast<double>(rays.size()));
  require_visible(fit.profile, fit.rms, closest_approach(rays, place));
  return fit;
}

}  // namespace tissue_stiffness
