#pragma once

#include <Eigen/Core>
#include <optional>

namespace tissue_stiffness {

/// Where a camera looks that orbits a body.
struct BodyView {
  Eigen::Vector3d centre;  ///< the point it looks at, in the frame of the body's points [m]
  double distance = 0.0;   ///< of the camera from the centre [m]
};

/// Returns a view that holds the whole body from every direction, with room for its motion. `angle`: vertical angle of view
/// [rad], `aspect`: width of the picture over its height. Points that are not finite do not count. Returns nothing for a
/// body without extent, an angle outside ]0, pi[ or an aspect that is not positive.
std::optional<BodyView> view_of_body(const Eigen::Matrix3Xd& points, double angle, double aspect);

}  // namespace tissue_stiffness
