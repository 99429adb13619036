#pragma once

#include <Eigen/Core>
#include <string>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

/// Lines of sight through the observed points of a contour, in the model frame: X = origin + t direction. The lines of a
/// slice are perpendicular to the image plane, in which t = 0.
struct ViewingRays {
  Eigen::Matrix3Xd origins;     ///< [m]
  Eigen::Matrix3Xd directions;  ///< unit vectors
  Eigen::VectorXd sigma;        ///< 1 sigma as an angle (pinhole, [rad]) or a length (slice, [m])
  Eigen::Index size() const { return origins.cols(); }
};

/// Throws InputError for an outline that is open, has fewer than `kMinOutlinePoints` points with a finite sigma, holds
/// numbers that are not finite, or crosses itself. It names the pixel of the crossing.
void check_outline(const Contour& contour);
constexpr Eigen::Index kMinOutlinePoints = 12;

/// Returns the rays of the points with a finite sigma. The points are in the undistorted image [pixel].
ViewingRays viewing_rays(const Contour& contour, const Camera& camera);

}  // namespace tissue_stiffness
