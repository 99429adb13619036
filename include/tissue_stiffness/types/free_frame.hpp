#pragma once

#include <Eigen/Core>
#include <functional>

#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// A free frame is one frame of a free run, compared with its recording.
struct FreeFrame {
  const Frame& frame;
  const Prediction& prediction;  ///< rows of the frame's observations, one after the other
  const Misfit& misfit;
  const Eigen::VectorXd& displacement;  ///< 3n [m]
  /// It returns the model's outline in a contour observation's image, as 2 x points in pixels and depth; see the report.
  std::function<Eigen::Matrix4Xd(const Observation&)> outline;
};
using FreeFrameVisitor = std::function<void(const FreeFrame&)>;

}  // namespace tissue_stiffness
