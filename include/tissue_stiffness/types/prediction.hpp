#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// One frame's measurement and the model's prediction of it, row by row. Observations whose points have no identity
/// (points, contour) give the signed distance of the measurement from the model along the normal. Their `measured` is 0,
/// and `predicted` is the negative of this distance. Rows of a force are in N and have no node.
struct Prediction {
  Eigen::VectorXd measured;   ///< y [m]
  Eigen::VectorXd predicted;  ///< h(x) [m]; NaN where the model has no counterpart
  Eigen::VectorXd sigma;      ///< standard deviation of each row's noise [m]
  Eigen::Matrix3Xd places;    ///< position at which each row was measured, in the model frame [m]
  Eigen::VectorXi nodes;      ///< nearest mesh node of each row, to show the misfit on the surface; kForceRow: a force
};
constexpr int kForceRow = -1;

}  // namespace tissue_stiffness
