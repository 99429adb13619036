#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// One frame's measurement against the model, row by row. Identity-free kinds (points, contour) give the signed distance of
/// the measurement from the model along the normal: measured is then 0 - the distance is in `predicted` with its sign
/// turned.
struct Prediction {
  Eigen::VectorXd measured;   ///< y [m]
  Eigen::VectorXd predicted;  ///< h(x) [m]; NaN where the model has no counterpart
  Eigen::VectorXd sigma;      ///< 1-sigma noise of each row [m]
  Eigen::Matrix3Xd places;    ///< where each row was measured, model frame [m]
  Eigen::VectorXi nodes;      ///< nearest mesh node of each row, for showing misfit on the surface
};

}  // namespace tissue_stiffness
