#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// Returns the filter's robust weights of a prediction's rows; 0 for rows without a model counterpart.
Eigen::VectorXd row_weights(const Prediction& prediction);

/// Compares the model with one frame's measurement. `rest` holds the rows predicted at rest, which the motion is counted
/// from.
Misfit frame_misfit(double time, const Prediction& prediction, const Eigen::VectorXd& rest, int node_count);

}  // namespace tissue_stiffness
