#pragma once

#include <Eigen/Core>
#include <string>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

/// Lines of sight through the seen points of a contour, in the model frame: X = origin + t direction. A slice's lines stand
/// upright on the image plane, with t = 0 in it.
struct ViewingRays {
  Eigen::Matrix3Xd origins;     ///< [m]
  Eigen::Matrix3Xd directions;  ///< unit
  Eigen::VectorXd sigma;        ///< angle (pinhole, [rad]) or length (slice, [m]) of one sigma
  Eigen::Index size() const { return origins.cols(); }
};

/// Throws InputError for an outline that is open, has fewer than `kMinOutlinePoints` points with a finite sigma, holds
/// numbers that are not finite, or crosses itself, saying at which pixel.
void check_outline(const Contour& contour);
constexpr Eigen::Index kMinOutlinePoints = 12;

/// Rays of the points with a finite sigma; points in the undistorted image [pixel].
ViewingRays viewing_rays(const Contour& contour, const Camera& camera);

}  // namespace tissue_stiffness
