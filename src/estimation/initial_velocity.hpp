#pragma once

#include <Eigen/Core>
#include <vector>

#include "forward/model.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

struct VelocityEstimate {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< [m/s]
  double std = 0.0;                                ///< [m/s], of each component
};

/// Returns the body's rigid velocity over the first frames: the slope of the observed centre over time. For two frames this
/// is eq. 24 of Yang & Lin (2016). An outline moves in the image plane only; along the line of sight the velocity is taken
/// as 0.
VelocityEstimate velocity_from_frames(const Model& model, const std::vector<Frame>& frames);

}  // namespace tissue_stiffness
