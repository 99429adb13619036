#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// Filter's robust weights of a prediction's rows; 0 for rows without a model counterpart.
Eigen::VectorXd row_weights(const Prediction& prediction);

/// Model against measurement; `rest` is the prediction at rest, for the size of the motion.
Misfit compare(double time, const Prediction& prediction, const Eigen::VectorXd& rest, int node_count);

}  // namespace tissue_stiffness
