#pragma once

#include <Eigen/Core>

#include "meshing/viewing_rays.hpp"
#include "tissue_stiffness/types/camera.hpp"

namespace tissue_stiffness {

/// A smooth surface of revolution that is star-shaped about its centre. At the angle t from the axis it lies at the
/// distance R(t) = sum_n c_n cos(n t) from the centre, which closes it smoothly at both poles.
class RevolutionProfile {
 public:
  RevolutionProfile(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis, const Eigen::VectorXd& coefficients)
      : centre_(centre), axis_(axis.normalized()), coefficients_(coefficients) {}

  const Eigen::Vector3d& centre() const { return centre_; }
  const Eigen::Vector3d& axis() const { return axis_; }
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

  double radius(double angle) const;        ///< R [m]
  double radius_slope(double angle) const;  ///< dR/dt [m/rad]

  /// Returns the distance from the axis and the height along it above the centre at an angle [m].
  Eigen::Vector2d meridian(double angle) const;

  double angle(const Eigen::Vector3d& point) const;  ///< angle from the axis, 0 to pi [rad]

  /// Returns the first-order signed distance from the surface, positive outside: (|x| - R) / |grad(|x| - R)| [m].
  double distance(const Eigen::Vector3d& point) const;

  /// Returns the outward unit normal of the level set through a point.
  Eigen::Vector3d normal(const Eigen::Vector3d& point) const;

  /// Returns a nearby point on the surface, along the normal.
  Eigen::Vector3d project(const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d gradient(const Eigen::Vector3d& point) const;

  Eigen::Vector3d centre_, axis_;
  Eigen::VectorXd coefficients_;
};

/// A profile that was fitted to an outline.
struct ProfileFit {
  RevolutionProfile profile;
  double rms = 0.0;        ///< rms distance of the lines of sight from the surface [m]
  double smoothing = 0.0;  ///< weight that was chosen for the integral
};

/// Finds the body of revolution whose silhouette is the outline: every line of sight touches it. The axis has the direction
/// `axis` and the depth of the model's origin (slice: it lies in the image plane). Its sideways position follows from the
/// outline. Gauss-Newton minimises sum (distance / sigma)^2 + smoothing * integral of (R'' + R - c_0)^2. The smoothing is
/// chosen by generalised cross-validation (Craven and Wahba 1979). So both sides of the outline count with 1/sigma^2, and
/// perspective needs no later correction. Throws InputError for an axis that points at the camera, and for an outline that
/// is not star-shaped about its centre.
ProfileFit fit_profile(const ViewingRays& rays, const Camera& camera, const Eigen::Vector3d& axis);

}  // namespace tissue_stiffness
